#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace semigeo::io {

/// Returns the number of bytes of the first character of `text`, or 0 if `text` is empty or does
/// not begin with a UTF-8 character.
std::size_t utf8_character(std::string_view text);

/// Removes the first character from `text`, which must not be empty, and returns its code point. A
/// byte that belongs to no character counts as U+FFFD.
char32_t take_utf8_character(std::string_view& text);

/// Returns whether `text` is UTF-8.
bool is_utf8(std::string_view text);

/// Returns `text` with U+FFFD in place of each byte that belongs to no character. File names are
/// bytes, but HDF5 and JSON hold text.
std::string as_utf8(std::string_view text);

}  // namespace semigeo::io
