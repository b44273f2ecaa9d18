#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace semigeo::jobs {

/// Returns a path as UTF-8 text: paths are bytes, JSON is text. '%' and bytes that are not UTF-8
/// become %XX.
std::string escaped(std::string_view path);
std::vector<std::string> escaped_all(std::vector<std::string> paths);

/// Returns the path that `escaped` has turned into this text.
std::string unescaped(const std::string& text);
std::vector<std::string> unescaped_all(std::vector<std::string> texts);

}  // namespace semigeo::jobs
