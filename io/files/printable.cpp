#include "io/files/printable.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>

#include "io/files/utf8.hpp"

namespace semigeo::io {
namespace {

/// A range of code points that are not shown as they are.
struct Range {
  std::uint32_t first;
  std::uint32_t last;
};
constexpr std::array<Range, 8> kUnprintable = {{{0x00, 0x1f},        // C0
                                                {0x7f, 0x9f},        // delete, C1
                                                {0x061c, 0x061c},    // Arabic letter mark
                                                {0x200e, 0x200f},    // left-to-right, right-to-left
                                                {0x2028, 0x202e},    // separators, overrides
                                                {0x2066, 0x2069},    // isolates
                                                {0xfeff, 0xfeff},    // byte order mark
                                                {0xfff9, 0xfffb}}};  // interlinear annotations

bool is_printable(std::uint32_t code) {
  return std::ranges::none_of(kUnprintable, [code](const Range& range) {
    return code >= range.first && code <= range.last;
  });
}

/// Returns the code point of one valid character.
std::uint32_t code_of(std::string_view character) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(character[i]); };
  if (character.size() == 1) return byte(0);
  std::uint32_t code = byte(0) & (0xffu >> (character.size() + 1));
  for (std::size_t i = 1; i < character.size(); ++i) code = code << 6 | (byte(i) & 0x3fu);
  return code;
}

std::string hexadecimal(const char* begin, std::uint32_t number, int digits) {
  std::array<char, 16> text;
  std::snprintf(text.data(), text.size(), "%s%0*x", begin, digits, number);
  return text.data();
}

std::string escape_of(std::uint32_t code) {
  if (code == '\n') return "\\n";
  if (code == '\t') return "\\t";
  if (code == '\r') return "\\r";
  return code < 0x80 ? hexadecimal("\\x", code, 2) : hexadecimal("\\u", code, 4);
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t bytes = utf8_character(text);
    const std::string_view character = text.substr(0, std::max<std::size_t>(bytes, 1));
    if (bytes == 0) {
      result += hexadecimal("\\x", static_cast<unsigned char>(text.front()), 2);
    } else if (const std::uint32_t code = code_of(character); !is_printable(code)) {
      result += escape_of(code);
    } else {
      result += character;
    }
    text.remove_prefix(character.size());
  }
  return result;
}

std::string printable_lines(std::string_view text) {
  std::string result;
  while (true) {
    const std::size_t end = text.find('\n');
    result += printable(text.substr(0, end));
    if (end == std::string_view::npos) return result;
    result += '\n';
    text.remove_prefix(end + 1);
  }
}

std::string printable_json(std::string_view document) {
  std::string result;
  while (!document.empty()) {
    const std::size_t bytes = std::max<std::size_t>(utf8_character(document), 1);
    const std::string_view character = document.substr(0, bytes);
    const std::uint32_t code = code_of(character);
    // Those below are spaces and line ends between values: inside of texts, JSON escapes them.
    const bool escaped = code > 0x1f && !is_printable(code);
    result += escaped ? hexadecimal("\\u", code, 4) : std::string(character);
    document.remove_prefix(bytes);
  }
  return result;
}

std::size_t count_characters(std::string_view text) {
  std::size_t count = 0;
  for (; !text.empty(); ++count) text.remove_prefix(std::max<std::size_t>(utf8_character(text), 1));
  return count;
}

std::string_view first_characters(std::string_view text, std::size_t count) {
  std::size_t bytes = 0;
  for (; count > 0 && bytes < text.size(); --count)
    bytes += std::max<std::size_t>(utf8_character(text.substr(bytes)), 1);
  return text.substr(0, bytes);
}

}  // namespace semigeo::io
