#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace semigeo::io {

/// Returns the number of bytes of the character that `text` begins with, or 0 if it is none of
/// UTF-8, or `text` is empty.
std::size_t utf8_character(std::string_view text);

/// Returns whether `text` is UTF-8.
bool is_utf8(std::string_view text);

/// Returns `text` with U+FFFD for every byte that belongs to no character: file names are bytes,
/// but HDF5 and JSON hold text.
std::string as_utf8(std::string_view text);

}  // namespace semigeo::io
