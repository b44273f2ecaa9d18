#pragma once

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

namespace semigeo::jobs::cli {

/// Returns a document as indented text. JSON must be UTF-8, but file names need not be: bytes that
/// are not UTF-8 become U+FFFD.
inline std::string text_of(const nlohmann::json& document) {
  return document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

/// Prints a document on stdout, as `text_of` returns it.
inline void print_document(const nlohmann::json& document) {
  std::fputs(text_of(document).c_str(), stdout);
}

}  // namespace semigeo::jobs::cli
