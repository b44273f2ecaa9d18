#include "io/scans/decimal.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>

namespace semigeo::io {
namespace {

constexpr std::uint64_t kExactMantissa = std::uint64_t{1} << 53;
constexpr std::ptrdiff_t kMaxDigits = 19;  // numbers of this many digits fit into 64 bits
constexpr int kMaxExactPower = 22;
constexpr double kPowersOfTen[kMaxExactPower + 1] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                     1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                     1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

bool is_digit(char c) {
  return static_cast<unsigned char>(c - '0') < 10;
}

/// Reads the exponent at `p`, limits it to +-99,999 and moves `p` behind it. If there is no
/// exponent, it returns 0 and leaves `p` where it is.
int parse_exponent(const char*& p, const char* last) {
  const char* q = p;
  if (q == last || (*q != 'e' && *q != 'E')) return 0;
  if (++q == last) return 0;
  const bool negative = *q == '-';
  if (*q == '-' || *q == '+') ++q;
  if (q == last || !is_digit(*q)) return 0;
  int exponent = 0;
  for (; q < last && is_digit(*q); ++q) exponent = std::min(exponent * 10 + (*q - '0'), 99'999);
  p = q;
  return negative ? -exponent : exponent;
}

/// Returns whether a nonzero number is below 1. It is called only for numbers that are too large or
/// too small for a double.
bool is_tiny(const char* first, const char* last) {
  const char* p = std::find_if(first, last, [](char c) { return c != '0'; });
  std::ptrdiff_t magnitude = 0;
  while (p < last && is_digit(*p)) ++p, ++magnitude;
  if (p < last && *p == '.') {
    const char* fraction = ++p;
    if (magnitude == 0) {
      p = std::find_if(p, last, [](char c) { return c != '0'; });
      magnitude = fraction - p;
    }
    p = std::find_if_not(p, last, is_digit);
  }
  return magnitude + parse_exponent(p, last) < 0;
}

/// Reads all numbers for which the short exact way does not work.
Decimal parse_general(const char* start, const char* first, const char* last, bool negative) {
  double value = 0;
  const auto [end, status] = std::from_chars(first, last, value);
  if (status == std::errc::invalid_argument) return {0, start};
  if (status == std::errc::result_out_of_range)
    value = is_tiny(first, end) ? 0.0 : std::numeric_limits<double>::infinity();
  return {negative ? -value : value, end};
}

}  // namespace

Decimal parse_decimal(std::string_view text) {
  const char* const start = text.data();
  const char* const last = start + text.size();
  const char* p = start;
  const bool negative = p < last && *p == '-';
  if (p < last && (*p == '-' || *p == '+')) ++p;
  const char* const first = p;

  // A mantissa below 2^53 and a power of ten up to 10^22 are exact, so one operation on them
  // rounds correctly. A mantissa that has wrapped is recognised by its number of digits.
  std::uint64_t mantissa = 0;
  for (; p < last && is_digit(*p); ++p) mantissa = mantissa * 10 + static_cast<unsigned>(*p - '0');
  std::ptrdiff_t digits = p - first;
  std::ptrdiff_t exponent = 0;
  if (p < last && *p == '.') {
    const char* const fraction = ++p;
    for (; p < last && is_digit(*p); ++p)
      mantissa = mantissa * 10 + static_cast<unsigned>(*p - '0');
    digits += p - fraction;
    exponent = fraction - p;
  }
  if (digits == 0 && first < last && *first == '-') return {0, start};  // "+-1", "--1"
  if (digits == 0) return parse_general(start, first, last, negative);
  if (p < last && *p == '#')  // "1.#QNAN", "-1.#IND", "1.#INF"
    return {std::numeric_limits<double>::quiet_NaN(), p};
  exponent += parse_exponent(p, last);
  if (digits > kMaxDigits || mantissa > kExactMantissa || exponent > kMaxExactPower ||
      exponent < -kMaxExactPower)
    return parse_general(start, first, last, negative);
  double value = static_cast<double>(mantissa);
  value = exponent < 0 ? value / kPowersOfTen[-exponent] : value * kPowersOfTen[exponent];
  return {negative ? -value : value, p};
}

}  // namespace semigeo::io
