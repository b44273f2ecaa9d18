#include "jobs/stages/pose_examiner.hpp"

#include <gtest/gtest.h>

#include <cmath>

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
  pose.overlap.stability = weights.half_held;
  EXPECT_NEAR(score_of(pose, weights), std::pow(0.5, weights.held), 1e-9);
  pose = perfect_pose();
  pose.support = 0;
  EXPECT_NEAR(score_of(pose, weights), std::pow(0.5, weights.explained), 1e-9);
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
  EXPECT_NEAR(view_score_of(pose, {}), 1.0 / 16, 1e-9);
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

}  // namespace
}  // namespace semigeo::jobs
