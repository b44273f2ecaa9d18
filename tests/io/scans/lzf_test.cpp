#include "io/scans/lzf.hpp"

#include <gtest/gtest.h>

namespace semigeo::io {
namespace {

using namespace std::string_literals;

TEST(LzfTest, CopiesLiteralBytes) {
  EXPECT_EQ(unpack_lzf("\x02"
                       "abc"s,
                       3),
            "abc");
  EXPECT_EQ(unpack_lzf("\x00"
                       "a"
                       "\x01"
                       "bc"s,
                       3),
            "abc");
  EXPECT_EQ(unpack_lzf("", 0), "");
}

TEST(LzfTest, CopiesFromWhatIsUnpacked) {
  EXPECT_EQ(unpack_lzf("\x02"
                       "abc"
                       "\x20\x02"s,
                       6),
            "abcabc");  // 3 bytes, 3 back
  EXPECT_EQ(unpack_lzf("\x00"
                       "a"
                       "\x60\x00"s,
                       6),
            "aaaaaa");  // overlapping
  EXPECT_EQ(unpack_lzf("\x00"
                       "a"
                       "\xe0\xff\x00"s,
                       265),
            std::string(265, 'a'));
  std::string far, plain;  // a distance of more than one byte
  for (int i = 0; i < 10; ++i) {
    const std::string block = "\x1f"s + std::string(32, static_cast<char>('a' + i));
    far += block;
    plain += block.substr(1);
  }
  EXPECT_EQ(unpack_lzf(far + "\x21\x3f"s, 323), plain + "aaa");  // 320 back
}

TEST(LzfTest, RefusesDamage) {
  EXPECT_FALSE(
      unpack_lzf("\x02"
                 "ab"s,
                 3));  // a literal is cut
  EXPECT_FALSE(
      unpack_lzf("\x02"
                 "abc"
                 "\x20"s,
                 6));  // a distance is missing
  EXPECT_FALSE(
      unpack_lzf("\x02"
                 "abc"
                 "\xe0\xff"s,
                 300));  // a length or distance is missing
  EXPECT_FALSE(
      unpack_lzf("\x02"
                 "abc"
                 "\x20\x03"s,
                 6));  // from before the start
  EXPECT_FALSE(
      unpack_lzf("\x02"
                 "abc"s,
                 4));  // too few bytes
  EXPECT_FALSE(
      unpack_lzf("\x02"
                 "abc"
                 "\x20\x02"s,
                 5));  // too many bytes
  EXPECT_FALSE(
      unpack_lzf("\x02"
                 "abc"s,
                 std::size_t{1} << 40));
}

}  // namespace
}  // namespace semigeo::io
