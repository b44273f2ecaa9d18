#include "jobs/stages/pose_examiner.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace semigeo::jobs {
namespace {

/// A pose in which all of the model lies on all of the scene, held fast by it.
ExaminedPose perfect_pose() {
  return {.pose = {},
          .support = 1e12,
          .overlap = {.match = 1, .conflict = 0, .closeness = 1, .stability = 1e12},
          .explained = 1};
}

TEST(ScoreTest, PerfectPosesHaveOneAndPosesWithoutMatchesZero) {
  EXPECT_NEAR(score_of(perfect_pose(), {}), 1, 1e-9);
  ExaminedPose pose = perfect_pose();
  pose.overlap.match = 0;
  EXPECT_EQ(score_of(pose, {}), 0);
}

TEST(ScoreTest, EachWeightIsTheExponentOfItsFactor) {
  const ScoreWeights weights;
  ExaminedPose pose = perfect_pose();
  pose.overlap.closeness = 0.9;
  EXPECT_NEAR(score_of(pose, weights), std::pow(0.9, weights.closeness), 1e-9);
  pose = perfect_pose();
  pose.overlap.conflict = 1;
  EXPECT_NEAR(score_of(pose, weights), std::pow(0.5, weights.unopposed), 1e-9);
  pose = perfect_pose();
  pose.support = 0;  // features hold it by nothing
  pose.overlap.stability = weights.half_held;
  EXPECT_NEAR(score_of(pose, weights), std::pow(0.5, weights.held + weights.explained), 1e-9);
  pose = perfect_pose();
  pose.support = 0;
  EXPECT_NEAR(score_of(pose, weights), std::pow(0.5, weights.explained), 1e-9);
}

/// A surface that slips is held by the features on it.
TEST(ScoreTest, FeaturesHoldAModelToo) {
  const ScoreWeights weights;
  ExaminedPose pose = perfect_pose();
  pose.overlap.stability = 0;
  pose.support = weights.half_held / weights.hold_of_support;
  const double wanted =
      (weights.prior_support + pose.support) / (2 * weights.prior_support + pose.support);
  EXPECT_NEAR(score_of(pose, weights),
              std::pow(0.5, weights.held) * std::pow(wanted, weights.explained), 1e-9);
  pose.support = 0;
  EXPECT_EQ(score_of(pose, weights), 0);
}

/// All of the model matches a quarter of the scene: only the share that is explained counts.
TEST(ScoreTest, SmallPartsOfAScenePayForWhatTheyLeave) {
  const ScoreWeights weights;
  ExaminedPose pose = perfect_pose();
  pose.explained = 0.25;
  EXPECT_NEAR(score_of(pose, weights), std::pow(0.25, weights.explained), 1e-9);
}

/// All that should be seen of a model, a fifth of it, is seen and matches.
ExaminedPose perfect_view() {
  ExaminedPose pose = perfect_pose();
  pose.overlap.match = 0.2;
  pose.overlap.view = {.there = 0.2, .behind = 0, .nothing = 0, .opposed = 0};
  return pose;
}

TEST(ViewScoreTest, WhatIsHiddenCountsOnlyIfItContradicts) {
  EXPECT_NEAR(view_score_of(perfect_view(), {}), 1, 1e-9);
  EXPECT_LT(score_of(perfect_view(), {}), 0.5);
  ExaminedPose pose = perfect_view();
  pose.overlap.conflict = pose.overlap.match / 4;  // of what was not seen
  EXPECT_NEAR(view_score_of(pose, {}), std::pow(0.8, ViewTuning{}.uncontradicted), 1e-9);
}

TEST(ViewScoreTest, WhatIsNotSeenWhereItShouldBeCounts) {
  ExaminedPose pose = perfect_view();
  pose.overlap.view.nothing = 0.2;
  EXPECT_NEAR(view_score_of(pose, {}), 0.25, 1e-9);
  pose = perfect_view();
  pose.overlap.view.behind = 0.6;
  EXPECT_NEAR(view_score_of(pose, {}), std::pow(0.25, 2 + ViewTuning{}.hides_nothing), 1e-9);
  pose = perfect_view();
  pose.overlap.view.opposed = 0.2;
  EXPECT_NEAR(view_score_of(pose, {}), std::pow(0.5, ViewTuning{}.score.unopposed), 1e-9);
}

TEST(ViewScoreTest, LittleThatMatchesIsWorthLess) {
  ExaminedPose pose = perfect_view();
  pose.overlap.match = 0.05;
  pose.overlap.view.there = 0.05;
  EXPECT_NEAR(view_score_of(pose, {}), 0.5, 1e-9);
  pose = perfect_view();
  pose.explained = 0.025;
  EXPECT_NEAR(view_score_of(pose, {}), std::pow(0.25, ViewTuning{}.score.explained), 1e-9);
  EXPECT_EQ(view_score_of({.pose = {}}, {}), 0);
}

/// Samples of a box of 2 x 1.5 x 1 about the origin, spread at random over its upper three faces or
/// all six.
kernels::RecognitionModel box(int faces, std::size_t count) {
  const Eigen::Vector3d half(1, 0.75, 0.5);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> along(-1, 1);
  std::discrete_distribution<int> normal_axis({1.5, 2, 3});  // by area
  kernels::RecognitionModel model;
  for (std::size_t i = 0; i < count; ++i) {
    const int axis = normal_axis(random);
    const double side = faces == 6 && along(random) < 0 ? -1 : 1;
    Eigen::Vector3d point =
        half.cwiseProduct(Eigen::Vector3d(along(random), along(random), along(random)));
    point[axis] = side * half[axis];
    model.samples.points.push_back(point.cast<float>());
    model.samples.normals.push_back((side * Eigen::Vector3d::Unit(axis)).cast<float>());
  }
  const double area = 6.5 * (faces == 6 ? 2 : 1);
  model.samples.spacing = static_cast<float>(std::sqrt(area / static_cast<double>(count)));
  model.diagonal = 2 * half.norm();
  model.centre.setZero();
  return model;
}

/// Adds a floor of 8 x 8 about the box, as dense as the samples.
void add_floor(kernels::RecognitionModel& scene) {
  const auto steps = static_cast<int>(8 / scene.samples.spacing);
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const float x = -4 + 8 * (static_cast<float>(i) + 0.5F) / static_cast<float>(steps);
      const float y = -4 + 8 * (static_cast<float>(j) + 0.5F) / static_cast<float>(steps);
      if (std::abs(x) < 1 && std::abs(y) < 0.75F) continue;
      scene.samples.points.emplace_back(x, y, -0.5F);
      scene.samples.normals.push_back(Eigen::Vector3f::UnitZ());
    }
}

/// Three faces of a box lie on those of a smaller or larger one with the same corner. Only what of
/// them hangs over the floor, or is missing, tells the size.
TEST(PoseExaminerTest, ABoxGrowsUntilItFillsItsFaces) {
  kernels::RecognitionModel scene = box(3, 6000);
  add_floor(scene);
  scene.eye = Eigen::Vector3d(300, 300, 300);
  const RecognitionTuning tuning;
  const PoseExaminer examiner(scene, tuning);
  ListedModel listed;
  listed.record = box(6, 4000);
  listed.tree.emplace(listed.record.samples);
  const Eigen::Vector3d corner(1, 0.75, 0.5);
  for (const double scale : {0.8, 1.25}) {
    ExaminedPose pose;
    pose.pose.scale = scale;
    pose.pose.translation = (1 - scale) * corner;
    examiner.measure(listed, pose, {});
    const auto better = examiner.better_scaled_pose(listed, pose);
    ASSERT_TRUE(better) << scale;
    EXPECT_GT(better->score, 1.05 * pose.score);
    EXPECT_NEAR(better->pose.scale, 1, 0.08);  // rims are as wide as samples lie apart
    EXPECT_LT((better->pose.apply(corner) - corner).norm(), 0.03);
  }
}

}  // namespace
}  // namespace semigeo::jobs
