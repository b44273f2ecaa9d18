#include "jobs/cli/failures.hpp"

#include <gtest/gtest.h>

namespace semigeo::jobs::cli {
namespace {

using Texts = std::vector<std::string>;

std::vector<Failure> failures_of(const Texts& sentences) {
  std::vector<Failure> failures;
  for (const std::string& sentence : sentences) failures.push_back({sentence});
  return failures;
}

std::string printed(const Texts& failures, bool told = false) {
  testing::internal::CaptureStdout();
  print_failures(failures_of(failures), told);
  return testing::internal::GetCapturedStdout();
}

TEST(FailuresTest, TheReasonIsTheProblemWithoutFilePlaceAndNumbers) {
  const auto groups =
      grouped(failures_of({"in/a.ply: line 4: the header promises 3 vertices; copy it again",
                           "in/b.ply: is empty; export it again",
                           "in/c 7.ply: line 12: the header promises 812 vertices; copy it"}));
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].count, 2u);
  EXPECT_EQ(groups[0].example, "in/a.ply: line 4: the header promises 3 vertices; copy it again");
  EXPECT_EQ(groups[1].count, 1u);
}

TEST(FailuresTest, AFileMayHaveANameLikeASentence) {
  EXPECT_EQ(grouped({{"a: b.ply: is empty", "a: b.ply"}, {"c.ply: is empty", "c.ply"}}).size(), 1u);
}

TEST(FailuresTest, AFewAreNamedOneByOne) {
  EXPECT_EQ(printed({}), "");
  EXPECT_EQ(printed({"a: is empty", "b: is empty"}), "failed: a: is empty\nfailed: b: is empty\n");
  EXPECT_EQ(printed({"a: is empty", "b: is empty"}, true), "");
}

TEST(FailuresTest, ManyAreCountedByReason) {
  Texts failures(4000, "a: is empty; export it");
  failures.emplace_back("b: its job crashed (signal 11)");
  EXPECT_EQ(printed(failures),
            "failed, 4000 times: a: is empty; export it\nfailed: b: its job crashed (signal 11)\n");
  EXPECT_EQ(printed(failures, true),
            "failed, 4000 times: a: is empty; export it\nfailed: 1 more, for another reason\n");
}

TEST(FailuresTest, OnlyTheMostFrequentReasonsAreNamed) {
  Texts failures;
  for (char reason = 'a'; reason <= 'z'; ++reason)
    failures.insert(failures.end(), static_cast<std::size_t>(reason - 'a' + 1),
                    std::string("x: problem ") + reason);
  EXPECT_EQ(printed(failures),
            "failed, 26 times: x: problem z\nfailed, 25 times: x: problem y\n"
            "failed, 24 times: x: problem x\nfailed: 276 more, for 23 other reasons\n");
}

TEST(FailuresTest, LongSentencesAreCutBetweenCharacters) {
  EXPECT_EQ(cut("short", 1), "short");
  const std::string kana(300, 'x');
  EXPECT_EQ(cut(kana, 2), std::string(155, 'x') + "...");
  std::string text;
  for (int i = 0; i < 100; ++i) text += "像";
  EXPECT_EQ(cut(text, 1).size(), 76u * 3 + 3);
}

TEST(FailuresTest, NoNameSteersTheTerminal) {
  EXPECT_EQ(printed({"a\x1b[31m\n: is empty"}), "failed: a\\x1b[31m\\n: is empty\n");
  EXPECT_EQ(printed(Texts(6, "a\x1b: is empty")), "failed, 6 times: a\\x1b: is empty\n");
}

}  // namespace
}  // namespace semigeo::jobs::cli
