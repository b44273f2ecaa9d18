#include "kernels/recognition/thesis/thesis_hash.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

namespace semigeo::kernels {
namespace {

OrientedFeature feature(const Eigen::Vector3f& position, float value,
                        FeatureKind kind = FeatureKind::kMean, int level = 1) {
  OrientedFeature result;
  result.position = position;
  result.normal = {0, 0, 1};
  result.value = value;
  result.code = feature_code(kind, value > 0);
  result.level = static_cast<std::uint8_t>(level);
  return result;
}

std::vector<std::uint16_t> all_of(const OrientedFeatures& features) {
  std::vector<std::uint16_t> chosen(features.features.size());
  for (std::size_t i = 0; i < chosen.size(); ++i) chosen[i] = static_cast<std::uint16_t>(i);
  return chosen;
}

OrientedFeatures random_features(int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> place(0, 1), value(0.1F, 1);
  std::bernoulli_distribution positive(0.5);
  OrientedFeatures result;
  for (int i = 0; i < count; ++i) {
    const float x = place(random), y = place(random), z = place(random);
    const float size = value(random);
    result.features.push_back(feature({x, y, z}, positive(random) ? size : -size));
  }
  return result;
}

TEST(ThesisTriplets, KeysOfATriangleWorkedOutByHand) {
  // A 3-4-5 triangle: corner 0 lies opposite the side of 5, at the right angle.
  OrientedFeatures features;
  features.features = {feature({3, 0, 0}, -1), feature({0, 4, 0}, 2), feature({0, 0, 0}, -4)};
  const auto triplets = thesis_triplets(features, all_of(features), {}, false);
  ASSERT_EQ(triplets.size(), 1);
  const ThesisTriplet& t = triplets[0];
  // Opposite 5: the right angle; opposite 4: (3, 0, 0); opposite 3: (0, 4, 0).
  EXPECT_EQ(t.corners, (std::array<std::uint16_t, 3>{2, 0, 1}));
  EXPECT_EQ(t.strongest, 0);
  EXPECT_FLOAT_EQ(t.length_ratios[0], 0.8F);
  EXPECT_FLOAT_EQ(t.length_ratios[1], 0.6F);
  EXPECT_FLOAT_EQ(t.feature_ratios[0], 0.25F);
  EXPECT_FLOAT_EQ(t.feature_ratios[1], -0.5F);
  EXPECT_FLOAT_EQ(t.indexed, -0.25F * 1.4F);  // (-1 + 2) / -4 x (4 + 3) / 5
  EXPECT_FLOAT_EQ(t.address, -2.5F + 1.4F);
}

TEST(ThesisTriplets, AreAllThatAreNotCollinear) {
  const OrientedFeatures features = random_features(12, 1);
  EXPECT_EQ(thesis_triplets(features, all_of(features), {.min_height = 0}, false).size(), 220);
  OrientedFeatures line;
  for (int i = 0; i < 5; ++i)
    line.features.push_back(feature({static_cast<float>(i), 0, 0}, 1 + 0.1F * i));
  EXPECT_TRUE(thesis_triplets(line, all_of(line), {}, false).empty());
  line.features.push_back(feature({0, 5, 0}, 1));
  EXPECT_EQ(thesis_triplets(line, all_of(line), {}, false).size(), 10);  // pairs of the five
  line.features.back().value = 0;
  EXPECT_TRUE(thesis_triplets(line, all_of(line), {}, false).empty());
}

TEST(ThesisTriplets, AreTheSameAfterASimilarityAndAScaleOfTheValues) {
  const OrientedFeatures features = random_features(8, 2);
  OrientedFeatures moved = features;
  const Eigen::Matrix3f rotation =
      Eigen::AngleAxisf(1.1F, Eigen::Vector3f(1, 2, 3).normalized()).toRotationMatrix();
  for (OrientedFeature& f : moved.features) {
    f.position = 3 * (rotation * f.position) + Eigen::Vector3f(5, -7, 2);
    f.value *= 0.5F;
  }
  const auto before = thesis_triplets(features, all_of(features), {}, false);
  const auto after = thesis_triplets(moved, all_of(moved), {}, false);
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(before[i].corners, after[i].corners);
    EXPECT_NEAR(before[i].address, after[i].address, 1e-4);
    EXPECT_NEAR(before[i].indexed, after[i].indexed, 1e-4);
  }
}

TEST(ThesisTriplets, ASceneHasEveryOrderThatTolerancesBlur) {
  // All sides and values equal: six orders, each corner the strongest in turn.
  OrientedFeatures features;
  features.features = {feature({1, 0, 0}, 1), feature({0, 1, 0}, 1), feature({0, 0, 1}, 1)};
  EXPECT_EQ(thesis_triplets(features, all_of(features), {}, true).size(), 18);
  EXPECT_EQ(thesis_triplets(features, all_of(features), {}, false).size(), 1);
  // 3-4-5 with 1, 2, 4: only one.
  features.features = {feature({3, 0, 0}, 1), feature({0, 4, 0}, 2), feature({0, 0, 0}, 4)};
  EXPECT_EQ(thesis_triplets(features, all_of(features), {}, true).size(), 1);
}

TEST(StrongestFeatures, AreOfOneKindAndLevelByTheirSize) {
  OrientedFeatures features;
  features.features = {feature({0, 0, 0}, 1),
                       feature({0, 0, 0}, -3),
                       feature({0, 0, 0}, 2),
                       feature({0, 0, 0}, 9, FeatureKind::kGaussian),
                       feature({0, 0, 0}, -9, FeatureKind::kMeanTorsion),
                       feature({0, 0, 0}, 9, FeatureKind::kMean, 0)};
  EXPECT_EQ(strongest_features(features, FeatureKind::kMean, 1, 2),
            (std::vector<std::uint16_t>{1, 2}));
  EXPECT_EQ(strongest_features(features, FeatureKind::kMean, 1, 10).size(), 3);
  EXPECT_EQ(strongest_features(features, FeatureKind::kMeanTorsion, 1, 10),
            (std::vector<std::uint16_t>{4}));
}

TEST(Agree, OnVAndOnEachRatioAndOnWhichIsTheStrongest) {
  const ThesisOptions options;
  const ThesisTriplet t{.address = 1,
                        .indexed = 0.5F,
                        .length_ratios = {0.8F, 0.6F},
                        .feature_ratios = {0.5F, -0.2F}};
  EXPECT_TRUE(agree(t, t, options));
  ThesisTriplet other = t;
  other.indexed += 0.16F;
  EXPECT_FALSE(agree(t, other, options));
  for (int i = 0; i < 2; ++i) {
    other = t;
    other.length_ratios[i] += 0.045F;
    EXPECT_TRUE(agree(t, other, options));
    other.length_ratios[i] += 0.01F;
    EXPECT_FALSE(agree(t, other, options));
    other = t;
    other.feature_ratios[i] -= 0.09F;
    EXPECT_TRUE(agree(t, other, options));
    other.feature_ratios[i] -= 0.02F;
    EXPECT_FALSE(agree(t, other, options));
  }
  other = t;
  other.strongest = 1;
  EXPECT_FALSE(agree(t, other, options));
}

TEST(ThesisTable, FindsWhatALookAtEveryEntryFinds) {
  ThesisOptions options;
  options.length_ratio = 0.2;
  options.feature_ratio = 0.4;
  options.indexed = 0.5;
  std::vector<ThesisTable::Entry> entries;
  for (std::uint32_t model = 0; model < 4; ++model) {
    const OrientedFeatures features = random_features(14, 10 + model);
    for (const ThesisTriplet& t : thesis_triplets(features, all_of(features), options, false))
      entries.push_back({t, model});
  }
  const ThesisTable table(entries, options);
  EXPECT_EQ(table.entries().size(), entries.size());
  const OrientedFeatures scene = random_features(14, 10);  // that of model 0
  std::int64_t found = 0, expected = 0, self = 0;
  for (const ThesisTriplet& t : thesis_triplets(scene, all_of(scene), options, true)) {
    table.for_matches(t, [&](const ThesisTable::Entry& entry) {
      ++found;
      self += entry.model == 0 && entry.triplet.corners == t.corners ? 1 : 0;
    });
    for (const auto& entry : entries)
      expected += std::abs(entry.triplet.address - t.address) < options.address &&
                          agree(t, entry.triplet, options)
                      ? 1
                      : 0;
  }
  EXPECT_EQ(found, expected);
  EXPECT_GT(found, 1000);
  // Every triplet of the model finds itself.
  EXPECT_GE(self, std::ssize(thesis_triplets(scene, all_of(scene), options, false)));
}

TEST(ThesisTable, AddressesBeyondTheRangeAreKept) {
  const ThesisOptions options;
  const ThesisTable table({{{.address = -40}, 7}, {{.address = 99}, 8}}, options);
  for (const auto& [address, model] : {std::pair(-40.0F, 7U), std::pair(99.0F, 8U)}) {
    std::vector<std::uint32_t> found;
    table.for_matches({.address = address},
                      [&](const auto& entry) { found.push_back(entry.model); });
    EXPECT_EQ(found, (std::vector<std::uint32_t>{model}));
  }
}

TEST(ThesisScore, IsVotesPerTripletInPerCent) {
  EXPECT_DOUBLE_EQ(thesis_score(120, 10), 100);  // 10 C 3 = 120
  EXPECT_DOUBLE_EQ(thesis_score(1, 3), 100);
  EXPECT_DOUBLE_EQ(thesis_score(2, 4), 50);
  EXPECT_DOUBLE_EQ(thesis_score(5, 2), 0);
}

}  // namespace
}  // namespace semigeo::kernels
