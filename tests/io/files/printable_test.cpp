#include "io/files/printable.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace semigeo::io {
namespace {

TEST(PrintableTest, NamesOfEveryScriptStayAsTheyAre) {
  for (const char* name : {"a.ply", "my scan 50%.ply", "Krug Nº 7", "Άγαλμα", "статуя", "像.ply",
                           "نقش", "हाथी", "👩‍🚀.ply", "back\\slash", "quote'\"", ""})
    EXPECT_EQ(printable(name), name);
}

TEST(PrintableTest, WhatSteersATerminalIsVisible) {
  EXPECT_EQ(printable("a\nb\tc\rd"), "a\\nb\\tc\\rd");
  EXPECT_EQ(printable("\x1b[2J\x1b]0;title\a"), "\\x1b[2J\\x1b]0;title\\x07");
  EXPECT_EQ(printable("\x7f"), "\\x7f");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "\\u009b31m");  // CSI of C1
  EXPECT_EQ(printable(std::string_view("\0", 1)), "\\x00");
}

TEST(PrintableTest, WhatTurnsTextAroundIsVisible) {
  EXPECT_EQ(printable("scan\u202eylp.exe"), "scan\\u202eylp.exe");
  EXPECT_EQ(printable("\u200e\u200f\u061c\u2066\u2069\u2028"),
            "\\u200e\\u200f\\u061c\\u2066\\u2069\\u2028");
}

TEST(PrintableTest, BytesThatAreNoCharactersAreVisible) {
  EXPECT_EQ(printable("\xff\xfe.ply"), "\\xff\\xfe.ply");
  EXPECT_EQ(printable("\x9b"), "\\x9b");
  EXPECT_EQ(printable("\xe2\x80"), "\\xe2\\x80");
}

TEST(PrintableTest, EveryControlCharacterIsReplaced) {
  for (int c = 0; c < 256; ++c) {
    const std::string text = printable(std::string(1, static_cast<char>(c)));
    for (const char shown : text) EXPECT_TRUE(shown >= ' ' && shown <= '~') << c;
  }
}

TEST(PrintableTest, LinesStayLines) {
  EXPECT_EQ(printable_lines("a\n\x1b\nb\n"), "a\n\\x1b\nb\n");
  EXPECT_EQ(printable_lines(""), "");
}

TEST(PrintableTest, JsonKeepsItsValues) {
  const nlohmann::json document = {{"name", "a\x1b\n\u009b\u202e\x7f像"}, {"list", {1, 2}}};
  const std::string text = printable_json(document.dump(2));
  EXPECT_EQ(nlohmann::json::parse(text), document);
  EXPECT_NE(text.find("\\u009b\\u202e\\u007f像"), std::string::npos) << text;
  EXPECT_EQ(text.find('\x7f'), std::string::npos);
}

TEST(PrintableTest, CharactersAreCountedNotBytes) {
  EXPECT_EQ(count_characters("像a"), 2u);
  EXPECT_EQ(count_characters("\xff"), 1u);
  EXPECT_EQ(first_characters("像aß", 2), "像a");
  EXPECT_EQ(first_characters("ab", 5), "ab");
}

}  // namespace
}  // namespace semigeo::io
