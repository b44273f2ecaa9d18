#include "io/files/number_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

namespace semigeo::io {
namespace {

/// It holds the longest number: 309 digits before the point and kMostDecimals behind it.
using Buffer = std::array<char, 352>;
constexpr int kMostDecimals = 20;

}  // namespace

std::string number_text(double value) {
  Buffer text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                 std::chars_format::general, std::numeric_limits<double>::digits10);
  return {text.data(), end.ptr};
}

std::string number_text(float value) {
  Buffer text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string fixed_text(double value, int decimals) {
  Buffer text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                 std::chars_format::fixed, std::min(decimals, kMostDecimals));
  return {text.data(), end.ptr};
}

}  // namespace semigeo::io
