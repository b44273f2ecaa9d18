#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace semigeo::io {

/// Returns `text` so that it may be shown in one line of a terminal. Characters of every script
/// stay as they are. Characters that would steer the terminal or turn the text around become
/// escapes of visible characters: control characters ("\n", "\x1b"), separators of lines, marks of
/// the writing direction ("\u202e"), and bytes that are not UTF-8 ("\xff"). Names of files may hold
/// all of them.
std::string printable(std::string_view text);

/// Returns a text of several lines, each of them as `printable` returns it.
std::string printable_lines(std::string_view text);

/// Returns the text of a JSON document with the characters that `printable` replaces as escapes of
/// JSON (\u009b). A reader of JSON gets the same text as before.
std::string printable_json(std::string_view document);

/// Returns the number of characters of a UTF-8 text. A byte that belongs to no character counts as
/// one.
std::size_t count_characters(std::string_view text);

/// Returns the first `count` characters of a UTF-8 text, or all of it if it has fewer.
std::string_view first_characters(std::string_view text, std::size_t count);

}  // namespace semigeo::io
