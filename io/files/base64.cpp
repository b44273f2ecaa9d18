#include "io/files/base64.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace semigeo::io {
namespace {

constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::int8_t kNone = -1, kBlank = -2, kPadding = -3;

constexpr std::array<std::int8_t, 256> kMeanings = [] {
  std::array<std::int8_t, 256> meanings{};
  meanings.fill(kNone);
  for (const char c : {' ', '\t', '\r', '\n'}) meanings[static_cast<unsigned char>(c)] = kBlank;
  meanings['='] = kPadding;
  for (std::size_t i = 0; i < kDigits.size(); ++i)
    meanings[static_cast<unsigned char>(kDigits[i])] = static_cast<std::int8_t>(i);
  return meanings;
}();

std::int8_t meaning(char c) {
  return kMeanings[static_cast<unsigned char>(c)];
}

}  // namespace

std::string base64(std::span<const std::byte> bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t first = 0; first < bytes.size(); first += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - first);
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 3; ++i)
      word = word << 8 | (i < count ? std::to_integer<std::uint32_t>(bytes[first + i]) : 0);
    for (std::size_t i = 0; i < 4; ++i)
      text += i <= count ? kDigits[word >> (18 - 6 * i) & 63] : '=';
  }
  return text;
}

bool Base64Decoder::next_group() {
  std::uint32_t bits = 0;
  int digits = 0, padding = 0;
  std::size_t at = 0;
  for (; at < text_.size() && digits + padding < 4; ++at) {
    const std::int8_t digit = meaning(text_[at]);
    if (digit == kBlank) continue;
    if (digit == kNone || (digit == kPadding && digits < 2) || (digit >= 0 && padding > 0))
      return false;
    bits = bits << 6 | static_cast<std::uint32_t>(std::max<std::int8_t>(digit, 0));
    (digit == kPadding ? padding : digits) += 1;
  }
  if (digits < 2) return false;
  for (int i = digits + padding; i < 4; ++i) bits <<= 6;  // a text may end without its padding
  text_.remove_prefix(at);
  for (int i = 0; i + 1 < digits; ++i) group_ += static_cast<char>(bits >> (16 - 8 * i));
  return true;
}

std::size_t Base64Decoder::read(std::size_t bytes, std::string& out) {
  std::size_t done = 0;
  while (done < bytes && (!group_.empty() || next_group())) {
    const std::size_t step = std::min(bytes - done, group_.size());
    out.append(group_, 0, step);
    group_.erase(0, step);
    done += step;
  }
  return done;
}

bool Base64Decoder::at_end() {
  return group_.empty() &&
         std::all_of(text_.begin(), text_.end(), [](char c) { return meaning(c) == kBlank; });
}

}  // namespace semigeo::io
