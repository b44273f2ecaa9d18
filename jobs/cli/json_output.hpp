#pragma once

#include <cstdio>
#include <nlohmann/json.hpp>

namespace semigeo::jobs::cli {

/// Prints a document on stdout. File names need not be UTF-8 but JSON must: what is not becomes
/// U+FFFD.
inline void print_document(const nlohmann::json& document) {
  std::printf("%s\n",
              document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
}

}  // namespace semigeo::jobs::cli
