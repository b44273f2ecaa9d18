#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace semigeo::jobs {

/// Returns a path as UTF-8 text, because paths are bytes, but JSON is text. '%' and bytes that are
/// not UTF-8 become %XX.
std::string escaped(std::string_view path);
/// Returns each of the paths as `escaped` does.
std::vector<std::string> escaped_all(std::vector<std::string> paths);

/// Returns the path that `escaped` has turned into this text.
std::string unescaped(const std::string& text);
/// Returns the path of each text as `unescaped` does.
std::vector<std::string> unescaped_all(std::vector<std::string> texts);

}  // namespace semigeo::jobs
