// Texts from files, as they become numbers, names and lines of a terminal.
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "io/files/base64.hpp"
#include "io/files/number_text.hpp"
#include "io/files/printable.hpp"
#include "io/files/utf8.hpp"
#include "io/scans/decimal.hpp"
#include "io/scans/lzf.hpp"
#include "jobs/archive/path_text.hpp"
#include "tests/fuzz/target.hpp"

namespace semigeo::fuzz {
namespace {

bool is_harmless(std::string_view text) {
  for (const char c : text)
    if ((static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == 0x7f) return false;
  return io::is_utf8(text);
}

void read_texts(std::string_view text) {
  const std::string shown = io::printable(text);
  check(is_harmless(shown) && shown.find('\n') == std::string::npos, "a text steers the terminal");
  check(is_harmless(io::printable_lines(text)), "lines steer the terminal");
  const std::string valid = io::as_utf8(text);
  check(io::is_utf8(valid), "a text is not UTF-8");
  check(io::is_utf8(text) == (valid == text), "a text of UTF-8 is changed");
  const std::size_t characters = io::count_characters(text);
  check(io::first_characters(text, characters) == text, "a text has more characters");
  check(io::count_characters(io::first_characters(text, characters / 2)) == characters / 2,
        "the beginning of a text has another length");
  const std::string path = jobs::escaped(text);
  check(io::is_utf8(path) && jobs::unescaped(path) == text, "a path is not read back");
  jobs::unescaped(std::string(text));
  const std::string document = nlohmann::json(valid).dump();
  check(nlohmann::json::parse(io::printable_json(document)) == nlohmann::json(valid),
        "JSON to print is other JSON");
}

void read_number(std::string_view text) {
  const io::Decimal decimal = io::parse_decimal(text);
  check(decimal.end >= text.data() && decimal.end <= text.data() + text.size(),
        "a number ends outside of its text");
  // A text that both read to the same end is the same number.
  double value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status == std::errc() && end == decimal.end && std::isfinite(decimal.value))
    check(decimal.value == value, "a number is read wrongly");
  check(!io::number_text(decimal.value).empty(), "a number has no text");
  if (std::abs(decimal.value) <= std::numeric_limits<float>::max()) {
    const auto narrow = static_cast<float>(decimal.value);
    check(static_cast<float>(io::parse_decimal(io::number_text(narrow)).value) == narrow,
          "a float is not read back");
  }
}

void read_base64(std::string_view text) {
  io::Base64Decoder decoder(text);
  std::string bytes;
  while (decoder.read(7, bytes) == 7) {
  }
  decoder.at_end();
  const std::string encoded = io::base64(std::as_bytes(std::span(bytes)));
  io::Base64Decoder again(encoded);
  std::string same;
  again.read(bytes.size() + 1, same);
  check(same == bytes && again.at_end(), "Base64 is not read back");
}

void read_lzf(std::string_view packed, std::size_t size) {
  if (const auto bytes = io::unpack_lzf(packed, size))
    check(bytes->size() == size, "LZF gives another number of bytes");
}

}  // namespace

void read_input(std::string_view bytes) {
  Numbers numbers(bytes);
  const unsigned kind = numbers.below(4);
  const std::size_t size = kind == 3 ? numbers.word() : 0;
  // A copy ends where the text ends, so that reading behind it is noticed.
  const std::string text(numbers.rest());
  const std::vector<char> exact(text.begin(), text.end());
  const std::string_view view(exact.data(), exact.size());
  if (kind == 0) read_texts(view);
  if (kind == 1) read_number(view);
  if (kind == 2) read_base64(view);
  if (kind == 3) read_lzf(view, size);
}

}  // namespace semigeo::fuzz
