#pragma once

#include <cstdio>
#include <nlohmann/json.hpp>

namespace semigeo::jobs::cli {

/// Prints a document on stdout. JSON must be UTF-8, but file names need not be: bytes that are not
/// UTF-8 become U+FFFD.
inline void print_document(const nlohmann::json& document) {
  std::printf("%s\n",
              document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
}

}  // namespace semigeo::jobs::cli
