#include "io/files/utf8.hpp"

#include <array>
#include <cstdint>

namespace semigeo::io {
namespace {

/// Describes characters of `bytes` bytes: the fixed bits of their first byte, and the least code
/// point that needs this number of bytes.
struct Form {
  std::size_t bytes;
  unsigned mask;
  unsigned lead;
  std::uint32_t least;
};
constexpr std::array<Form, 4> kForms = {
    {{1, 0x80, 0x00, 0}, {2, 0xe0, 0xc0, 0x80}, {3, 0xf0, 0xe0, 0x800}, {4, 0xf8, 0xf0, 0x10000}}};
constexpr std::uint32_t kLast = 0x10ffff;
constexpr bool is_surrogate(std::uint32_t code) {
  return code >= 0xd800 && code <= 0xdfff;
}

}  // namespace

std::size_t utf8_character(std::string_view text) {
  if (text.empty()) return 0;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  for (const Form& form : kForms) {
    if ((byte(0) & form.mask) != form.lead) continue;
    if (text.size() < form.bytes) return 0;
    std::uint32_t code = byte(0) & ~form.mask & 0xff;
    for (std::size_t i = 1; i < form.bytes; ++i) {
      if ((byte(i) & 0xc0) != 0x80) return 0;
      code = code << 6 | (byte(i) & 0x3fu);
    }
    const bool valid = code >= form.least && code <= kLast && !is_surrogate(code);
    return valid ? form.bytes : 0;
  }
  return 0;
}

char32_t take_utf8_character(std::string_view& text) {
  const std::size_t bytes = utf8_character(text);
  const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  char32_t code = bytes == 0 ? 0xfffd : byte(0);
  if (bytes > 1) code &= 0x7fu >> bytes;
  for (std::size_t i = 1; i < bytes; ++i) code = code << 6 | (byte(i) & 0x3fu);
  text.remove_prefix(bytes == 0 ? 1 : bytes);
  return code;
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t bytes = utf8_character(text);
    if (bytes == 0) return false;
    text.remove_prefix(bytes);
  }
  return true;
}

std::string as_utf8(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t bytes = utf8_character(text);
    result += bytes == 0 ? "\xef\xbf\xbd" : text.substr(0, bytes);
    text.remove_prefix(bytes == 0 ? 1 : bytes);
  }
  return result;
}

}  // namespace semigeo::io
