#include "jobs/bench/schedule.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace semigeo::jobs {
namespace {

std::vector<int> counts_of(const std::vector<int>& order, int cases) {
  std::vector<int> counts(cases);
  for (const int i : order) ++counts[i];
  return counts;
}

TEST(InterleavedTest, EveryCaseGetsTheLeastWhateverItCosts) {
  const std::vector<int> order =
      interleaved(std::vector<double>{100, 1}, {.least = 3, .most = 9, .seconds = 1});
  EXPECT_EQ(counts_of(order, 2), (std::vector<int>{3, 3}));
}

TEST(InterleavedTest, TimeThatIsLeftGoesToTheFewestAndTheCheapest) {
  // The least takes 2 * (4 + 1) = 10 of 16.5; then cheap, dear, cheap again, and no more fits.
  const std::vector<int> order =
      interleaved(std::vector<double>{4, 1}, {.least = 2, .most = 9, .seconds = 16.5});
  EXPECT_EQ(counts_of(order, 2), (std::vector<int>{3, 4}));
}

TEST(InterleavedTest, NoCaseIsMeasuredMoreOftenThanTheMost) {
  const std::vector<int> order =
      interleaved(std::vector<double>{0.1, 0.1, 0.1}, {.least = 2, .most = 5, .seconds = 1000});
  EXPECT_EQ(counts_of(order, 3), (std::vector<int>{5, 5, 5}));
}

TEST(InterleavedTest, RepetitionsOfACaseAreSpreadOverTheWholeTime) {
  const std::vector<int> order =
      interleaved(std::vector<double>{1, 1, 1}, {.least = 4, .most = 4, .seconds = 0});
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2}));
}

TEST(InterleavedTest, FewRepetitionsLieBetweenThoseOfManyOnes) {
  const std::vector<int> order =
      interleaved(std::vector<double>{10, 1}, {.least = 2, .most = 8, .seconds = 28});
  ASSERT_EQ(counts_of(order, 2), (std::vector<int>{2, 8}));
  const auto first = std::ranges::find(order, 0) - order.begin();
  EXPECT_EQ(first, 2);  // a quarter of the way, where two of eight are done
  EXPECT_EQ(order[7], 0);
}

TEST(InterleavedTest, NothingToMeasureIsNoOrder) {
  EXPECT_TRUE(interleaved({}, {.seconds = 10}).empty());
}

}  // namespace
}  // namespace semigeo::jobs
