#include "kernels/features/scale_selection.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace semigeo::kernels {
namespace {

TEST(ScaleSelectionTest, WhereTheCountsStopFalling) {
  // Falling to a shelf over levels 9 to 13, then falling again.
  std::vector<std::int64_t> counts;
  for (int k = 0; k < 24; ++k)
    counts.push_back(k < 9 ? 1000 - 90 * k : k < 14 ? 190 : 190 - 15 * (k - 13));
  const ScaleSelection selection = select_scale(counts);
  EXPECT_NEAR(selection.level, 11, 1);
  ASSERT_EQ(selection.smoothed.size(), counts.size());
  EXPECT_NEAR(selection.smoothed[4], counts[4], 1e-6);  // straight lines stay
}

TEST(ScaleSelectionTest, SmoothingKeepsAConstantAndEvensOutASpike) {
  const std::vector<std::int64_t> flat(9, 40);
  for (const double value : select_scale(flat).smoothed) EXPECT_NEAR(value, 40, 1e-9);
  EXPECT_EQ(select_scale(flat).level, 0);
  std::vector<std::int64_t> spike(9, 0);
  spike[4] = 100;
  EXPECT_NEAR(select_scale(spike).smoothed[4], 39.9, 0.1);
}

TEST(ScaleSelectionTest, FewLevels) {
  EXPECT_EQ(select_scale(std::vector<std::int64_t>{}).level, 0);
  EXPECT_EQ(select_scale(std::vector<std::int64_t>{7}).level, 0);
  EXPECT_EQ(select_scale(std::vector<std::int64_t>{100, 50, 40, 38, 37}).level, 4);
}

TEST(ScaleSelectionTest, WhatHasVanishedIsNotStable) {
  std::vector<std::int64_t> counts(30, 0);
  for (int k = 0; k < 12; ++k) counts[k] = 400 - 30 * k;
  EXPECT_LE(select_scale(counts).level, 10);
  EXPECT_EQ(select_scale(std::vector<std::int64_t>(5, 0)).level, 0);
}

}  // namespace
}  // namespace semigeo::kernels
