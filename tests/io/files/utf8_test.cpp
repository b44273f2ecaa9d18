#include "io/files/utf8.hpp"

#include <gtest/gtest.h>

namespace semigeo::io {
namespace {

TEST(Utf8, CharactersOfEveryLength) {
  EXPECT_EQ(utf8_character("ab"), 1U);
  EXPECT_EQ(utf8_character("µm"), 2U);
  EXPECT_EQ(utf8_character("日本"), 3U);
  EXPECT_EQ(utf8_character("\U0001F600"), 4U);
  EXPECT_EQ(utf8_character("\U0010FFFF"), 4U);
  EXPECT_EQ(utf8_character(""), 0U);
  EXPECT_TRUE(is_utf8("Krug Nº 7, 日本, \U0001F600"));
  EXPECT_TRUE(is_utf8(""));
}

TEST(Utf8, WhatIsNoneIsFound) {
  for (const char* text :
       {"\xff", "\x80", "\xc3", "\xc3(", "\xe6\x97", "\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80",
        "\xf4\x90\x80\x80", "\xf0\x80\x80\xaf", "\xf8\x88\x80\x80\x80"}) {
    EXPECT_EQ(utf8_character(text), 0U) << text;
    EXPECT_FALSE(is_utf8(std::string("a") + text + "b")) << text;
  }
}

TEST(Utf8, WhatIsNoneIsReplacedAndTheRestStays) {
  EXPECT_EQ(as_utf8("Nº 7"), "Nº 7");
  EXPECT_EQ(as_utf8("bad\xffname"), "bad\uFFFDname");
  EXPECT_EQ(as_utf8("\xe6\x97"), "\uFFFD\uFFFD");
  EXPECT_TRUE(is_utf8(as_utf8("\xc3(\xed\xa0\x80\xf0")));
}

TEST(Utf8, CharactersAreTakenOneByOne) {
  std::string_view text = "a\xc3\xa9\xff\xe5\x85\x94\xf0\x9f\x90\x87";
  std::u32string codes;
  while (!text.empty()) codes += take_utf8_character(text);
  EXPECT_EQ(codes, U"a\u00e9\ufffd\u5154\U0001f407");
}

}  // namespace
}  // namespace semigeo::io
