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

}  // namespace
}  // namespace semigeo::jobs
