#include "io/files/json_value.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <nlohmann/json.hpp>

namespace semigeo::io {
namespace {

template <typename Value>
Value value_in(const char* text) {
  Value value{};
  read_value(nlohmann::json::parse(text), value);
  return value;
}

TEST(JsonValue, WholeNumbersArriveWhole) {
  EXPECT_EQ(value_in<int>("-3"), -3);
  EXPECT_EQ(value_in<std::int64_t>("-9223372036854775808"), INT64_MIN);
  EXPECT_EQ(value_in<std::uint64_t>("18446744073709551615"), UINT64_MAX);
}

TEST(JsonValue, OtherNumbersAreNoWholeNumbers) {
  for (const char* text :
       {"18446744073709551616", "1e300", "-1e300", "0.5", "1.0", "true", "\"1\""})
    EXPECT_THROW(value_in<std::uint64_t>(text), nlohmann::json::exception) << text;
}

TEST(JsonValue, NumbersBeyondTheirTypeAreRefused) {
  EXPECT_EQ(value_in<int>("2147483647"), INT32_MAX);
  EXPECT_THROW(value_in<int>("2147483648"), nlohmann::json::exception);
  EXPECT_THROW(value_in<int>("4294967296"), nlohmann::json::exception);
  EXPECT_THROW(value_in<int>("-2147483649"), nlohmann::json::exception);
  EXPECT_THROW(value_in<std::int64_t>("9223372036854775808"), nlohmann::json::exception);
  EXPECT_THROW(value_in<std::uint64_t>("-1"), nlohmann::json::exception);
}

TEST(JsonValue, OtherValuesArriveAsTheyAre) {
  EXPECT_EQ(value_in<double>("1e300"), 1e300);
  EXPECT_EQ(value_in<double>("2"), 2);
  EXPECT_TRUE(value_in<bool>("true"));
  EXPECT_EQ(value_in<std::string>("\"a\""), "a");
}

}  // namespace
}  // namespace semigeo::io
