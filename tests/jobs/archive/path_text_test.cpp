#include "jobs/archive/path_text.hpp"

#include <gtest/gtest.h>

#include "io/files/utf8.hpp"

namespace semigeo::jobs {
namespace {

TEST(PathTextTest, TextStaysAsItIs) {
  for (const char* path : {"", "/a/b c.ply", "Krug N\u00ba 7/\U0001f3fa.obj", "a\nb\"\\\t"})
    EXPECT_EQ(escaped(path), path);
}

TEST(PathTextTest, WhatIsNoTextBecomesCodes) {
  EXPECT_EQ(escaped("100%.ply"), "100%25.ply");
  EXPECT_EQ(escaped("a\xff.ply"), "a%FF.ply");
  EXPECT_EQ(escaped("\xc2"), "%C2");                // a character that ends too early
  EXPECT_EQ(escaped("\xed\xa0\x80"), "%ED%A0%80");  // half of a surrogate pair
  EXPECT_EQ(escaped("\xc3\xa4\xe4"), "\u00e4%E4");  // the same letter as UTF-8 and as Latin-1
}

TEST(PathTextTest, EveryPairOfBytesComesBack) {
  for (int first = 1; first < 256; ++first)
    for (int second = 1; second < 256; ++second) {
      const std::string path = {'/', static_cast<char>(first), static_cast<char>(second)};
      const std::string text = escaped(path);
      ASSERT_TRUE(io::is_utf8(text)) << first << ' ' << second;
      ASSERT_EQ(unescaped(text), path) << first << ' ' << second;
    }
}

TEST(PathTextTest, NamesThatLookLikeCodesComeBack) {
  for (const char* path : {"%41", "%", "%%", "a%4", "%zz", "%25", "%\xff"})
    EXPECT_EQ(unescaped(escaped(path)), path);
}

TEST(PathTextTest, WhatIsNoCodeIsText) {
  for (const char* text : {"%", "%4", "%zz", "%4z", "a%"}) EXPECT_EQ(unescaped(text), text);
  EXPECT_EQ(unescaped("%e4"), "\xe4");
}

}  // namespace
}  // namespace semigeo::jobs
