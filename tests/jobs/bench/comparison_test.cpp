#include "jobs/bench/comparison.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace semigeo::jobs {
namespace {

Spread between(double low, double median, double high) {
  return {.median = median, .min = low, .max = high, .low = low, .high = high};
}

ComparedRate compared(const Spread& before, const Spread& now) {
  const std::vector<NamedRate> old = {{.name = "level/x/threads:1", .unit = "u", .rate = before}};
  const std::vector<NamedRate> fresh = {{.name = "level/x/threads:1", .unit = "u", .rate = now}};
  return compare(old, fresh).rates.at(0);
}

TEST(ComparisonTest, AFigureFellIfItIsBelowTheBoundAndTheRangesLieApart) {
  const ComparedRate rate = compared(between(95, 100, 105), between(75, 80, 85));
  EXPECT_DOUBLE_EQ(rate.ratio(), 0.8);
  EXPECT_TRUE(rate.fell_below(0.9));
  EXPECT_STREQ(rate.verdict(), "slower");
}

TEST(ComparisonTest, ADifferenceWithinTheSpreadOfEitherIsNone) {
  const ComparedRate wide_now = compared(between(95, 100, 105), between(60, 80, 96));
  EXPECT_FALSE(wide_now.fell_below(0.9));
  EXPECT_STREQ(wide_now.verdict(), "within spread");
  EXPECT_FALSE(compared(between(79, 100, 105), between(75, 80, 85)).fell_below(0.9));
}

TEST(ComparisonTest, ASmallDifferenceIsNoFallHoweverClear) {
  const ComparedRate rate = compared(between(99.9, 100, 100.1), between(94.9, 95, 95.1));
  EXPECT_FALSE(rate.fell_below(0.9));
  EXPECT_TRUE(rate.fell_below(0.96));
  EXPECT_STREQ(rate.verdict(), "slower");
}

TEST(ComparisonTest, WhatIsFasterDoesNotFall) {
  const ComparedRate rate = compared(between(95, 100, 105), between(195, 200, 205));
  EXPECT_FALSE(rate.fell_below(1));
  EXPECT_STREQ(rate.verdict(), "faster");
}

TEST(ComparisonTest, OtherProcessesAreNotTheFiguresFault) {
  const Spread before = between(95, 100, 105), now = between(45, 50, 55);
  NamedRate old = {.name = "a", .unit = "u", .rate = before, .cpu_rate = 100};
  NamedRate fresh = {.name = "a", .unit = "u", .rate = now, .cpu_rate = 98, .disturbed = true};
  const auto rate = [&] { return compare(std::vector{old}, std::vector{fresh}).rates.at(0); };
  EXPECT_FALSE(rate().fell_below(0.9));
  EXPECT_STREQ(rate().verdict(), "disturbed");
  fresh.cpu_rate = 60;  // it does take more
  EXPECT_TRUE(rate().fell_below(0.9));
  fresh.cpu_rate = 98;
  fresh.disturbed = false;  // nobody was there: it waits longer
  EXPECT_TRUE(rate().fell_below(0.9));
}

TEST(ComparisonTest, FiguresThatOnlyOneSideHasAreNamed) {
  const std::vector<NamedRate> before = {{.name = "gone", .unit = "u"},
                                         {.name = "unit", .unit = "u"}};
  const std::vector<NamedRate> now = {{.name = "new", .unit = "u"}, {.name = "unit", .unit = "v"}};
  const Comparison comparison = compare(before, now);
  EXPECT_TRUE(comparison.rates.empty());
  EXPECT_EQ(comparison.only_now, (std::vector<std::string>{"new", "unit"}));
  EXPECT_EQ(comparison.only_then, std::vector<std::string>{"gone"});
}

TEST(ComparisonTest, TheMachineFailsNothing) {
  const Spread before = between(95, 100, 105), now = between(45, 50, 55);
  const std::vector<std::string> names = {"machine/memory/threads:1", "level/x/threads:1"};
  std::vector<NamedRate> old, fresh;
  for (const std::string& name : names) {
    old.push_back({.name = name, .unit = "u", .rate = before});
    fresh.push_back({.name = name, .unit = "u", .rate = now});
  }
  const std::vector<ComparedRate> fell = fallen(compare(old, fresh), 0.9);
  ASSERT_EQ(fell.size(), 1U);
  EXPECT_EQ(fell[0].name, names[1]);
}

TEST(ComparisonTest, ABaselineOfZeroSaysNothing) {
  EXPECT_EQ(compared({}, between(1, 2, 3)).ratio(), 1);
}

}  // namespace
}  // namespace semigeo::jobs
