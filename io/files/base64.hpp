#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace semigeo::io {

/// Returns bytes as Base64 with padding. Source: RFC 4648, section 4.
std::string base64(std::span<const std::byte> bytes);

/// Returns the bytes of numbers, in the order of this machine, as Base64.
template <typename Number>
std::string base64_of(const std::vector<Number>& numbers) {
  return base64(std::as_bytes(std::span(numbers)));
}

/// Decodes Base64 text from front to back. Blanks and line ends are passed over. Padding may stand
/// between two parts that were encoded each for itself, as in files of VTK.
class Base64Decoder {
 public:
  explicit Base64Decoder(std::string_view text) : text_(text) {}

  /// Appends up to `bytes` decoded bytes to `out` and returns how many there were: fewer than asked
  /// only at the end of the text, or before a character that is not Base64.
  std::size_t read(std::size_t bytes, std::string& out);
  /// Returns whether only blanks are left behind what was read.
  bool at_end();

 private:
  bool next_group();  // false at the end, or before what is not Base64

  std::string_view text_;
  std::string group_;  // decoded and not yet given
};

}  // namespace semigeo::io
