#include "jobs/report/base64.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string_view>

namespace semigeo::jobs {
namespace {

std::string encoded(std::string_view text) {
  return base64(std::as_bytes(std::span(text)));
}

// RFC 4648, section 10.
TEST(Base64Test, TestVectorsOfTheStandard) {
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

TEST(Base64Test, NumbersAreLittleEndian) {
  EXPECT_EQ(base64_of(std::vector<std::uint16_t>{0xff00, 0x0001}), "AP8BAA==");
}

}  // namespace
}  // namespace semigeo::jobs
