#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "io/files/printable.hpp"
#include "jobs/cli/output.hpp"

namespace semigeo::jobs::cli {

/// Returns a document as indented text. JSON must be UTF-8, but file names need not be: bytes that
/// are not UTF-8 become U+FFFD. Characters that steer a terminal are escaped.
inline std::string text_of(const nlohmann::json& document) {
  return io::printable_json(
             document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace)) +
         "\n";
}

/// Prints a document on stdout, as `text_of` returns it.
inline void print_document(const nlohmann::json& document) {
  print_text(text_of(document));
}

}  // namespace semigeo::jobs::cli
