#pragma once

#include <string>

namespace semigeo::bench {

/// Returns a text as a cell of a CSV file: in quotes, with its own quotes doubled.
inline std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + '"';
}

}  // namespace semigeo::bench
