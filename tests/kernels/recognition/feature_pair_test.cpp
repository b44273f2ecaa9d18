#include "kernels/recognition/feature_pair.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/support/random_features.hpp"

namespace semigeo::kernels {
namespace {

using Eigen::Vector3f;

PairOptions as_scene() {
  PairOptions options;
  options.neighbours = 16;
  options.every_order = true;
  return options;
}

/// Pairs of `model` that find themselves in `scene`, whose features are the same ones.
int found_again(const std::vector<FeaturePair>& scene, const std::vector<FeaturePair>& model) {
  std::set<std::uint32_t> found;
  for (const PairMatch& match : match_pairs(scene, model))
    if (scene[match.scene].corners == model[match.model].corners) found.insert(match.model);
  return static_cast<int>(found.size());
}

TEST(FeaturePair, EachPairIsThereOnceWithinTheBand) {
  const OrientedFeatures features = random_features(120, 1);
  const PairOptions options;
  const std::vector<FeaturePair> pairs = local_pairs(features, options);
  EXPECT_GT(pairs.size(), 300U);
  std::set<std::array<std::uint16_t, 2>> seen;
  for (const FeaturePair& pair : pairs) {
    const OrientedFeature& p = features.features[pair.corners[0]];
    const OrientedFeature& q = features.features[pair.corners[1]];
    EXPECT_LE(p.code, q.code);
    EXPECT_EQ(pair.codes, p.code * kFeatureCodes + q.code);
    EXPECT_NEAR(pair.length, (p.position - q.position).norm(), 1e-5);
    EXPECT_GE(pair.length, options.nearest);
    EXPECT_LE(pair.length, options.farthest);
    EXPECT_LT((pair.frame.transpose() * pair.frame - Eigen::Matrix3f::Identity()).norm(), 1e-5);
    // The mean normal lies in the frame's plane, so across it the two are opposite.
    EXPECT_NEAR(pair.normals[0].z(), -pair.normals[1].z(), 1e-5);
    std::array<std::uint16_t, 2> corners = pair.corners;
    std::ranges::sort(corners);
    EXPECT_TRUE(seen.insert(corners).second) << "a pair entered twice";
  }
  EXPECT_TRUE(std::ranges::is_sorted(pairs, {}, &FeaturePair::codes));
}

TEST(FeaturePair, ASimilarityLosesNone) {
  std::mt19937_64 random(2);
  const OrientedFeatures features = random_features(80, 2);
  const std::vector<FeaturePair> model = local_pairs(features, {});
  for (int trial = 0; trial < 5; ++trial) {
    const std::vector<FeaturePair> scene =
        local_pairs(moved(features, random_similarity(random)), as_scene());
    EXPECT_EQ(found_again(scene, model), std::ssize(model));
  }
}

TEST(FeaturePair, OneMatchTellsTheSimilarity) {
  std::mt19937_64 random(3);
  const OrientedFeatures features = random_features(40, 3);
  const Similarity truth = random_similarity(random);
  const std::vector<FeaturePair> model = local_pairs(features, {});
  const std::vector<FeaturePair> scene = local_pairs(moved(features, truth), as_scene());
  int same = 0;
  for (const PairMatch& match : match_pairs(scene, model)) {
    if (scene[match.scene].corners != model[match.model].corners) continue;
    const Similarity found = similarity_between(model[match.model], scene[match.scene]);
    EXPECT_NEAR(found.scale, truth.scale, 1e-4 * truth.scale);
    EXPECT_LT(rotation_between(found.rotation, truth.rotation), 1e-4);
    EXPECT_LT((found.translation - truth.translation).norm(), 1e-3 * truth.scale);
    ++same;
  }
  EXPECT_GT(same, 50);
}

// Two features of one kind: the model has one order, the scene does not know which.
TEST(FeaturePair, AlikeFeaturesMatchBothWays) {
  OrientedFeatures features = random_features(2, 4);
  features.features[0].position = {0, 0, 0};
  features.features[1].position = {4, 0, 0};
  for (OrientedFeature& feature : features.features) {
    feature.normal = Vector3f(0, 0, 1);
    feature.code = 0;
    feature.scale_free_gaussian = feature.scale_free_mean = 0.5F;
  }
  EXPECT_EQ(local_pairs(features, {}).size(), 1U);
  EXPECT_EQ(local_pairs(features, as_scene()).size(), 2U);
  EXPECT_EQ(match_pairs(local_pairs(features, as_scene()), local_pairs(features, {})).size(), 2U);
  features.features[1].code = 1;
  EXPECT_EQ(local_pairs(features, as_scene()).size(), 1U);
}

TEST(FeaturePair, NormalsThatCancelOrLieAlongTellNoTurn) {
  OrientedFeatures features = random_features(2, 5);
  features.features[0].position = {0, 0, 0};
  features.features[1].position = {4, 0, 0};
  features.features[0].normal = {0, 0, 1};
  features.features[1].normal = {0, 0, -1};
  EXPECT_TRUE(local_pairs(features, {}).empty());
  features.features[0].normal = features.features[1].normal = {1, 0, 0};
  EXPECT_TRUE(local_pairs(features, {}).empty());
}

TEST(FeaturePair, LevelsDoNotMix) {
  OrientedFeatures features = random_features(60, 6);
  features.level_scale = {1, 1.5F};
  for (std::size_t i = 30; i < 60; ++i) features.features[i].level = 1;
  const std::vector<FeaturePair> pairs = local_pairs(features, {});
  ASSERT_GT(pairs.size(), 50U);
  for (const FeaturePair& pair : pairs)
    EXPECT_EQ(features.features[pair.corners[0]].level, features.features[pair.corners[1]].level);
}

TEST(FeaturePair, TolerancesAreThoseOfTriplets) {
  const OrientedFeatures features = random_features(30, 7);
  const FeaturePair pair = local_pairs(features, {}).front();
  const auto with = [&](const auto& change) {
    FeaturePair other = pair;
    change(other);
    return compatible(pair, other);
  };
  EXPECT_TRUE(with([](FeaturePair& p) { p.log_length += 0.34F; }));
  EXPECT_FALSE(with([](FeaturePair& p) { p.log_length += 0.36F; }));
  for (std::size_t i = 0; i < 4; ++i) {
    const float larger = (std::abs(pair.curvatures[i]) + 0.25F) / 0.65F;
    EXPECT_TRUE(with([&](FeaturePair& p) {
      p.curvatures[i] = std::copysign(0.99F * larger, pair.curvatures[i]);
    }));
    EXPECT_FALSE(with([&](FeaturePair& p) {
      p.curvatures[i] = std::copysign(1.01F * larger, pair.curvatures[i]);
    }));
  }
  const auto turned = [](double degrees) {
    return Eigen::AngleAxisf(static_cast<float>(degrees * std::numbers::pi / 180),
                             Vector3f::UnitX());
  };
  const Vector3f normal = {0, 1, 0};
  FeaturePair flat = pair;
  flat.normals = {normal, normal};
  FeaturePair other = flat;
  other.normals[1] = turned(29) * normal;
  EXPECT_TRUE(compatible(flat, other));
  other.normals[1] = turned(31) * normal;
  EXPECT_FALSE(compatible(flat, other));
}

TEST(FeaturePair, NothingGivesNothing) {
  EXPECT_TRUE(local_pairs({}, {}).empty());
  EXPECT_TRUE(local_pairs(random_features(1, 1), as_scene()).empty());
  EXPECT_TRUE(match_pairs({}, local_pairs(random_features(30, 1), {})).empty());
  EXPECT_TRUE(match_pairs(local_pairs(random_features(30, 1), {}), {}).empty());
}

}  // namespace
}  // namespace semigeo::kernels
