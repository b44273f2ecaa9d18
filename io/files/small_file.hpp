#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace semigeo::io {

/// The bounds of a file that is read into memory as a whole.
struct TextBounds {
  std::int64_t bytes = std::int64_t{1} << 20;  ///< A larger file is an error.
  int depth = 16;                              ///< Most brackets of JSON inside each other.
};

/// Returns the bytes of a regular file of limited size. Anything else at the path - a pipe, a
/// device, a folder, a larger file - is an Error, without waiting for it and without reading it.
/// What the system refuses is a ReadError.
std::string read_text(const std::filesystem::path& path, const TextBounds& bounds);

/// Returns the JSON object in the text, or a discarded value if it is none, or if more brackets
/// stand inside each other than `bounds` allow.
nlohmann::json parse_json(const std::string& text, const TextBounds& bounds);

/// Returns the JSON object in a file, as read_text and parse_json do. What is no such object is
/// found out in constant memory.
nlohmann::json read_json(const std::filesystem::path& path, const TextBounds& bounds);

/// Returns whether the file has exactly these bytes. A file that cannot be read has not.
bool has_text(const std::filesystem::path& path, std::string_view text);

/// Writes a small file whole or not at all (write_file_atomically), unless it has these bytes
/// already.
void write_if_different(const std::filesystem::path& path, std::string_view text);

}  // namespace semigeo::io
