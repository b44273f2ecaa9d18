#pragma once

#include <string>
#include <string_view>

namespace semigeo::io {

/// Returns a letter of ASCII in lower case, every other character as it is, in any locale.
constexpr char lower_case(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// Returns a text with its letters of ASCII in lower case.
inline std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = lower_case(c);
  return lower;
}

}  // namespace semigeo::io
