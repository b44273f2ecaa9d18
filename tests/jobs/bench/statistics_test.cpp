#include "jobs/bench/statistics.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace semigeo::jobs {
namespace {

TEST(SpreadTest, OfNothingIsZero) {
  const Spread spread = spread_of({});
  EXPECT_EQ(spread.median, 0);
  EXPECT_EQ(spread.relative(), 0);
  EXPECT_EQ(median_of({}), 0);
}

TEST(SpreadTest, OfFewRepetitionsIsTheWholeRange) {
  const std::vector<double> values = {5, 1, 3, 2, 100};
  const Spread spread = spread_of(values);
  EXPECT_EQ(spread.median, 3);
  EXPECT_EQ(spread.min, 1);
  EXPECT_EQ(spread.max, 100);
  EXPECT_EQ(spread.low, 1);
  EXPECT_EQ(spread.high, 100);
  EXPECT_EQ(spread.relative(), 99.0 / 6);
}

TEST(SpreadTest, SevenRepetitionsLoseAnExtremeAtEachEnd) {
  const std::vector<double> values = {10, 11, 12, 13, 14, 15, 1000};
  const Spread spread = spread_of(values);
  EXPECT_EQ(spread.median, 13);
  EXPECT_EQ(spread.low, 11);
  EXPECT_EQ(spread.high, 15);
  EXPECT_EQ(spread.max, 1000);
}

TEST(SpreadTest, TheMedianOfAnEvenNumberIsTheMeanOfTheMiddle) {
  EXPECT_EQ(median_of(std::vector<double>{4, 1, 2, 10}), 3);
}

}  // namespace
}  // namespace semigeo::jobs
