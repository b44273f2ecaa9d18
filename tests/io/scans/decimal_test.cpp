#include "io/scans/decimal.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

namespace semigeo::io {
namespace {

void expect_number(const std::string& text, double value, std::size_t length) {
  const Decimal decimal = parse_decimal(text);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(decimal.value), std::bit_cast<std::uint64_t>(value))
      << text;
  EXPECT_EQ(decimal.end - text.data(), static_cast<std::ptrdiff_t>(length)) << text;
}

TEST(Decimal, ReadsEverySpelling) {
  for (const auto& [text, value] :
       {std::pair<const char*, double>{"0", 0},
        {"-0", -0.0},
        {"+1.5", 1.5},
        {"1.", 1},
        {".5", 0.5},
        {"-.5", -0.5},
        {"1e5", 1e5},
        {"1E+05", 1e5},
        {"1.25e-3", 1.25e-3},
        {"007", 7},
        {"1e-400", 0},
        {"-1e-400", -0.0},
        {"0.1", 0.1},
        {"123456789012345678901234567890", 123456789012345678901234567890.0},
        {"0e99999999999", 0},
        {"1e23", 1e23}})
    expect_number(text, value, std::string(text).size());
  expect_number("0." + std::string(400, '0') + "1", 0, 403);
  expect_number("0." + std::string(400, '0') + "1e401", 1, 407);
}

TEST(Decimal, StopsBehindTheNumber) {
  expect_number("1.5 2", 1.5, 3);
  expect_number("1.5.2", 1.5, 3);
  expect_number("12e", 12, 2);
  expect_number("12e+", 12, 2);
  expect_number("12ex", 12, 2);
  expect_number("3/4", 3, 1);
}

TEST(Decimal, RefusesWhatIsNoNumber) {
  for (const char* text : {"", "-", "+", ".", "e5", "-.e5", "abc", "+-1", "--1", "++1", " 1", ",5"})
    expect_number(text, 0, 0);
}

TEST(Decimal, RecognisesWhatIsNotFinite) {
  for (const std::string text : {"nan", "NaN", "-nan", "inf", "-INF", "+Infinity", "1e999",
                                 "-1e400", "1.#QNAN", "-1.#IND", "1.#INF", "nan(ind)"}) {
    const Decimal decimal = parse_decimal(text);
    EXPECT_FALSE(std::isfinite(decimal.value)) << text;
    EXPECT_NE(decimal.end, text.data());
  }
  EXPECT_FALSE(std::isfinite(parse_decimal(std::string(400, '9')).value));
}

/// Every number as printf writes it is read as the C library reads it.
TEST(Decimal, AgreesWithTheCLibrary) {
  std::mt19937_64 random(1);
  const char* const formats[] = {"%.3f",  "%.6g", "%.9g", "%.15g", "%.17g",
                                 "%.20g", "%e",   "%.0f", "%.12f"};
  char text[512];
  for (int i = 0; i < 100'000; ++i) {
    double value = std::bit_cast<double>(random());
    if (i % 2 == 0) value = static_cast<double>(static_cast<std::int64_t>(random())) * 1e-16;
    if (!std::isfinite(value)) continue;
    const int length = std::snprintf(text, sizeof text, formats[i % std::size(formats)], value);
    expect_number(text, std::strtod(text, nullptr), static_cast<std::size_t>(length));
  }
}

}  // namespace
}  // namespace semigeo::io
