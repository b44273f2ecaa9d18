#include "io/files/base64.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace semigeo::io {
namespace {

std::string encoded(std::string_view text) {
  return base64(std::as_bytes(std::span(text)));
}

std::string decoded(std::string_view text, bool whole = true) {
  Base64Decoder decoder(text);
  std::string bytes;
  decoder.read(text.size(), bytes);
  EXPECT_EQ(decoder.at_end(), whole) << text;
  return bytes;
}

// RFC 4648, section 10.
TEST(Base64, EncodesTheExamplesOfItsStandard) {
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

TEST(Base64, NumbersAreLittleEndian) {
  EXPECT_EQ(base64_of(std::vector<std::uint16_t>{0xff00, 0x0001}), "AP8BAA==");
}

// RFC 4648, section 10.
TEST(Base64, DecodesTheExamplesOfItsStandard) {
  EXPECT_EQ(decoded(""), "");
  EXPECT_EQ(decoded("Zg=="), "f");
  EXPECT_EQ(decoded("Zm8="), "fo");
  EXPECT_EQ(decoded("Zm9v"), "foo");
  EXPECT_EQ(decoded("Zm9vYg=="), "foob");
  EXPECT_EQ(decoded("Zm9vYmE="), "fooba");
  EXPECT_EQ(decoded("Zm9vYmFy"), "foobar");
}

TEST(Base64, DecodesEveryByte) {
  std::string bytes;
  for (int i = 0; i < 256; ++i) bytes += static_cast<char>(i);
  EXPECT_EQ(decoded(encoded(bytes)), bytes);
}

TEST(Base64, PassesOverBlanksAndPaddingInTheMiddle) {
  EXPECT_EQ(decoded(" Zm\n9v\r\n\tYg = = \n"), "foob");
  EXPECT_EQ(decoded("Zg==Zm8=Zm9v"), "ffofoo");
  EXPECT_EQ(decoded("Zm9vYg"), "foob") << "the last padding may be missing";
}

TEST(Base64, StopsBeforeWhatIsNotBase64) {
  EXPECT_EQ(decoded("Zm9v*m9v", false), "foo");
  EXPECT_EQ(decoded("Zm9v=m9v", false), "foo");
  EXPECT_EQ(decoded("Zm9vZg=v", false), "foo");
  EXPECT_EQ(decoded("Zm9vZ", false), "foo");
}

TEST(Base64, ReadsInSteps) {
  Base64Decoder decoder("Zm9vYmFy");
  std::string bytes;
  EXPECT_EQ(decoder.read(1, bytes), 1u);
  EXPECT_EQ(decoder.read(3, bytes), 3u);
  EXPECT_EQ(bytes, "foob");
  EXPECT_FALSE(decoder.at_end());
  EXPECT_EQ(decoder.read(9, bytes), 2u);
  EXPECT_EQ(bytes, "foobar");
  EXPECT_TRUE(decoder.at_end());
}

}  // namespace
}  // namespace semigeo::io
