#pragma once

#include <string>

namespace semigeo::bench {

/// A cell of a CSV file: within quotes, its own doubled.
inline std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + '"';
}

}  // namespace semigeo::bench
