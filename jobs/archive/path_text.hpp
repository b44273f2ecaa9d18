#pragma once

#include <string>
#include <string_view>

namespace semigeo::jobs {

/// A path as UTF-8 text: paths are bytes, JSON is text. '%' and what is no UTF-8 become %XX.
std::string escaped(std::string_view path);
/// The path again.
std::string unescaped(const std::string& text);

}  // namespace semigeo::jobs
