#include "io/files/number_text.hpp"

#include <gtest/gtest.h>

#include <clocale>
#include <limits>
#include <random>

namespace semigeo::io {
namespace {

TEST(NumberTextTest, MapCoordinatesKeepTheirMillimetres) {
  EXPECT_EQ(number_text(5123456.789), "5123456.789");
  EXPECT_EQ(number_text(-432109.001), "-432109.001");
  EXPECT_EQ(number_text(5123456789.123), "5123456789.123");
  EXPECT_EQ(number_text(512345678901.234), "512345678901.234");
}

TEST(NumberTextTest, ADecimalNumberOfFifteenDigitsIsPrintedAsItWasWritten) {
  for (const char* text : {"0", "1", "-0.5", "0.1", "123456789012345", "1.23456789012345",
                           "0.000123456789012345", "1e-09", "1e+20", "-9.87654321e-05"})
    EXPECT_EQ(number_text(std::stod(text)), text);
}

TEST(NumberTextTest, RoundingErrorsStayOutOfSight) {
  EXPECT_EQ(number_text(0.1 + 0.2), "0.3");
  EXPECT_EQ(number_text(0.5f + 5123456.289), "5123456.789");
}

TEST(NumberTextTest, WhatIsPrintedIsTheNumberToFifteenDigits) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> mantissa(-10, 10);
  for (int exponent = -30; exponent <= 30; ++exponent) {
    const double value = std::stod("1e" + std::to_string(exponent)) * mantissa(random);
    EXPECT_NEAR(std::stod(number_text(value)) / value, 1, 5e-15) << exponent;
  }
}

TEST(NumberTextTest, AFloatReadsBackAsItself) {
  EXPECT_EQ(number_text(0.1f), "0.1");
  EXPECT_EQ(number_text(16777216.f), "16777216");
  std::mt19937 random(7);
  std::normal_distribution<float> values;
  for (int i = 0; i < 1000; ++i) {
    const float value = values(random);
    EXPECT_EQ(std::stof(number_text(value)), value);
  }
}

TEST(NumberTextTest, FixedTextHasItsDecimals) {
  EXPECT_EQ(fixed_text(2.0 / 3, 3), "0.667");
  EXPECT_EQ(fixed_text(1234.5678, 0), "1235");
  EXPECT_EQ(fixed_text(-0.5, 2), "-0.50");
  EXPECT_EQ(fixed_text(std::numeric_limits<double>::max(), 20).size(), 309u + 21);
}

TEST(NumberTextTest, TheLocaleDoesNotMatter) {
  for (const char* name : {"de_DE.UTF-8", "C.UTF-8", "C"}) std::setlocale(LC_ALL, name);
  EXPECT_EQ(number_text(0.25), "0.25");
  EXPECT_EQ(fixed_text(0.25, 2), "0.25");
}

}  // namespace
}  // namespace semigeo::io
