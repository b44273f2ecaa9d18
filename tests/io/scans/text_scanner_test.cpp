#include "io/scans/text_scanner.hpp"

#include "tests/io/scans/scan_files.hpp"

namespace semigeo::io {
namespace {

/// The words of a text, lines separated by "|".
std::string words(std::string_view text, TextSyntax syntax = {}) {
  const tests::TemporaryFolder folder;
  ByteSource source(write_file(folder / "text", text));
  TextScanner scanner(source, syntax);
  std::string all;
  do {
    while (!scanner.at_line_end()) (all += scanner.word()) += ' ';
    all += '|';
  } while (scanner.next_line());
  return all;
}

TEST(TextScanner, SeparatesWordsAndLines) {
  EXPECT_EQ(words(""), "|");
  EXPECT_EQ(words("a"), "a |");
  EXPECT_EQ(words("  a\tb \n\nc\n"), "a b ||c ||");
  EXPECT_EQ(words("a\r\nb\r\n"), "a |b ||");
  EXPECT_EQ(words("a\rb\r\rc"), "a |b ||c |");
  EXPECT_EQ(words("a # b"), "a # b |");
}

TEST(TextScanner, KnowsCommentsAndContinuations) {
  const TextSyntax obj{.hash_comments = true, .backslash_continues = true};
  EXPECT_EQ(words("a#b\n#c\nd", obj), "a ||d |");
  EXPECT_EQ(words("a \\\nb\\\r\nc\nd\\e", obj), "a b c |d\\e |");
  EXPECT_EQ(words("a \\\n\\\n\nb", obj), "a |b |");
  EXPECT_EQ(words("a # b\\\nc\\", obj), "a |c\\ |");
}

/// Whatever lies across the end of the window must read as if it did not.
TEST(TextScanner, DoesNotSeeTheWindow) {
  const std::string tail = " 1.25 -77\\\r\n 3\r\nword #x\r\n";
  for (std::size_t shift = 0; shift < tail.size() + 2; ++shift) {
    const std::string blanks(ByteSource::kWindowBytes - shift, ' ');
    EXPECT_EQ(words(blanks + tail, {.hash_comments = true, .backslash_continues = true}),
              "1.25 -77 3 |word ||");
    const std::string line(ByteSource::kWindowBytes - shift, 'x');
    const tests::TemporaryFolder folder;
    ByteSource source(write_file(folder / "text", "skip " + line + "\n" + tail));
    TextScanner scanner(source);
    EXPECT_EQ(scanner.word(), "skip");
    ASSERT_TRUE(scanner.next_line());
    EXPECT_EQ(scanner.number("a number"), 1.25);
    EXPECT_EQ(scanner.line(), 2);
  }
}

TEST(TextScanner, CountsLinesOfAllKinds) {
  const tests::TemporaryFolder folder;
  ByteSource source(write_file(folder / "text", "1\r\n\r\n3 \\\n4\n5"));
  TextScanner scanner(source, {.backslash_continues = true});
  scanner.next_line();
  ASSERT_TRUE(scanner.skip_to_content());
  EXPECT_EQ(scanner.integer("3"), 3);
  EXPECT_EQ(scanner.line(), 3);
  EXPECT_EQ(scanner.integer("4"), 4);
  EXPECT_EQ(scanner.line(), 4);
}

}  // namespace
}  // namespace semigeo::io
