#include "kernels/recognition/pose_clusters.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/support/random_similarity.hpp"

namespace semigeo::kernels {
namespace {

using Eigen::Vector3d;

const Vector3d kCentre(0.2, -0.1, 0.4);
constexpr double kDiagonal = 2;

/// The pose, a little off in everything.
Similarity shaken(const Similarity& pose, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  Similarity result = pose;
  result.scale *= std::exp(0.05 * uniform(random));
  result.rotation =
      Eigen::AngleAxisd(0.1 * uniform(random), random_direction(random)).toRotationMatrix() *
      pose.rotation;
  const Vector3d centre =
      pose.apply(kCentre) + 0.02 * kDiagonal * pose.scale * random_direction(random);
  result.translation = centre - result.scale * (result.rotation * kCentre);
  return result;
}

std::vector<PoseVote> votes_for(const Similarity& pose, int count, double weight,
                                std::mt19937_64& random) {
  std::vector<PoseVote> votes;
  for (int i = 0; i < count; ++i) votes.push_back({shaken(pose, random), weight});
  return votes;
}

double centre_error(const Similarity& a, const Similarity& b) {
  return (a.apply(kCentre) - b.apply(kCentre)).norm() / (kDiagonal * b.scale);
}

TEST(PoseClusters, FindTwoPosesAmongManyOthers) {
  std::mt19937_64 random(1);
  const Similarity first = random_similarity(random);
  const Similarity second = random_similarity(random);
  std::vector<PoseVote> votes = votes_for(first, 40, 1, random);
  for (const PoseVote& vote : votes_for(second, 40, 0.5, random)) votes.push_back(vote);
  for (int i = 0; i < 2000; ++i) votes.push_back({random_similarity(random), 0.3});
  std::ranges::shuffle(votes, random);

  const auto clusters = PoseVotes(votes, kCentre, kDiagonal).clusters();
  ASSERT_GE(clusters.size(), 2U);
  EXPECT_NEAR(clusters[0].weight, 40, 1);
  EXPECT_NEAR(clusters[1].weight, 20, 1);
  // Means of many are nearer than any one of them.
  EXPECT_LT(centre_error(clusters[0].pose, first), 0.01);
  EXPECT_LT(rotation_between(clusters[0].pose.rotation, first.rotation), 0.03);
  EXPECT_NEAR(clusters[0].pose.scale / first.scale, 1, 0.02);
  EXPECT_LT(centre_error(clusters[1].pose, second), 0.01);
}

TEST(PoseClusters, OnePoseIsOneCluster) {
  std::mt19937_64 random(2);
  const Similarity pose = random_similarity(random);
  const auto votes = votes_for(pose, 100, 1, random);
  const auto clusters = PoseVotes(votes, kCentre, kDiagonal).clusters();
  ASSERT_FALSE(clusters.empty());
  EXPECT_NEAR(clusters[0].weight, 100, 5);
  for (std::size_t i = 1; i < clusters.size(); ++i) EXPECT_LT(clusters[i].weight, 50);
}

TEST(PoseClusters, ReachIsAsSaid) {
  const auto weight_of = [](const Similarity& other) {
    const std::vector<PoseVote> votes = {{{}, 1}, {other, 1}};
    return PoseVotes(votes, Vector3d::Zero(), kDiagonal).clusters().front().weight;
  };
  const auto turned = [](double angle) {
    return Similarity{.rotation = Eigen::AngleAxisd(angle, Vector3d::UnitX()).toRotationMatrix()};
  };
  EXPECT_EQ(weight_of(turned(0.28)), 2);
  EXPECT_EQ(weight_of(turned(0.32)), 1);
  EXPECT_EQ(weight_of({.scale = std::exp(0.19)}), 2);
  EXPECT_EQ(weight_of({.scale = std::exp(0.21)}), 1);
  EXPECT_EQ(weight_of({.translation = Vector3d(0.19, 0, 0)}), 2);
  EXPECT_EQ(weight_of({.translation = Vector3d(0.21, 0, 0)}), 1);
}

TEST(PoseClusters, SupportIsTheWeightAboutAPose) {
  std::mt19937_64 random(4);
  const Similarity pose = random_similarity(random);
  const auto votes = votes_for(pose, 50, 0.5, random);
  const PoseVotes all(votes, kCentre, kDiagonal);
  EXPECT_NEAR(all.support(pose, {}), 25, 1e-4);
  EXPECT_LT(all.support(pose, {.angle = 0.05}), 20);
  EXPECT_EQ(all.support(random_similarity(random), {}), 0);
}

TEST(PoseClusters, SeedsOfOneWeightAreSpreadOverAllScales) {
  std::mt19937_64 random(5);
  const auto at_scale = [&](double least, double most) {
    Similarity pose = random_similarity(random);
    pose.scale = std::uniform_real_distribution(least, most)(random);
    return pose;
  };
  // Of the votes of weight 1, those that agree have the largest scale.
  const Similarity right = at_scale(2, 2);
  std::vector<PoseVote> votes = votes_for(right, 60, 1, random);
  for (int i = 0; i < 2000; ++i) votes.push_back({at_scale(0.1, 1), 1});
  for (int i = 0; i < 20'000; ++i) votes.push_back({at_scale(3, 10), 0.1});
  const auto clusters = PoseVotes(votes, kCentre, kDiagonal).clusters({.seeds = 200});
  EXPECT_NEAR(clusters.front().weight, 60, 1);
  EXPECT_LT(centre_error(clusters.front().pose, right), 0.01);
}

TEST(PoseClusters, AsManyAsWanted) {
  std::mt19937_64 random(3);
  std::vector<PoseVote> votes;
  for (int i = 0; i < 1000; ++i) votes.push_back({random_similarity(random), 1});
  EXPECT_EQ(PoseVotes(votes, kCentre, kDiagonal).clusters({.most = 7}).size(), 7U);
  EXPECT_TRUE(PoseVotes({}, kCentre, kDiagonal).clusters().empty());
}

}  // namespace
}  // namespace semigeo::kernels
