#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace semigeo::io {

/// Bytes of the character that `text` begins with; 0 if that is none of UTF-8, or `text` is empty.
std::size_t utf8_character(std::string_view text);

bool is_utf8(std::string_view text);

/// `text` with U+FFFD for every byte that belongs to no character: file names are bytes, but HDF5
/// and JSON hold text.
std::string as_utf8(std::string_view text);

}  // namespace semigeo::io
