#include "kernels/recognition/near_features.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/support/random_features.hpp"

namespace semigeo::kernels {
namespace {

TEST(NearFeatures, AreThoseOfTheDefinition) {
  const OrientedFeatures features = random_features(150, 3);
  const auto& all = features.features;
  NearFeatures near;
  near.find(all, 2.5, 9, 7);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto distance = [&](std::size_t j) { return (all[j].position - all[i].position).norm(); };
    std::vector<std::uint16_t> expected;
    for (std::size_t j = 0; j < all.size(); ++j)
      if (distance(j) >= 2.5 && distance(j) <= 9) expected.push_back(static_cast<std::uint16_t>(j));
    std::ranges::sort(expected, {}, distance);
    expected.resize(std::min<std::size_t>(expected.size(), 7));
    EXPECT_TRUE(std::ranges::equal(near.of(i), expected)) << i;
  }
}

// On a line, a unit apart: both ends of the band belong to it, and of equally near ones the
// earlier comes first.
TEST(NearFeatures, BothEndsOfTheBandBelongToIt) {
  OrientedFeatures features = random_features(7, 1);
  for (int i = 0; i < 7; ++i) features.features[i].position = {static_cast<float>(i), 0, 0};
  NearFeatures near;
  near.find(features.features, 1, 2, 10);
  EXPECT_EQ((std::vector<std::uint16_t>(near.of(3).begin(), near.of(3).end())),
            (std::vector<std::uint16_t>{2, 4, 1, 5}));
  near.find(std::span(features.features).first(1), 1, 2, 10);
  EXPECT_TRUE(near.of(0).empty());
}

TEST(NearFeatures, LevelsComeOneByOne) {
  OrientedFeatures features = random_features(5, 2);
  features.level_scale = {1, 2, 4};
  features.features[3].level = features.features[4].level = 2;
  std::vector<std::array<std::size_t, 2>> levels;
  std::vector<float> scales;
  for_each_level(features, [&](auto of_level, float sigma, std::size_t first) {
    levels.push_back({first, of_level.size()});
    scales.push_back(sigma);
  });
  EXPECT_EQ(levels, (std::vector<std::array<std::size_t, 2>>{{0, 3}, {3, 2}}));
  EXPECT_EQ(scales, (std::vector<float>{1, 4}));
}

}  // namespace
}  // namespace semigeo::kernels
