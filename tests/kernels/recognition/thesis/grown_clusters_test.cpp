#include "kernels/recognition/thesis/grown_clusters.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace semigeo::kernels {
namespace {

const Eigen::Vector3d kCentre(10, 0, 0);
const Eigen::Vector3d kOrigin(0, 0, 0);
constexpr double kDiagonal = 2;

/// Takes the model's centre to `place`.
Similarity pose(double scale, double angle, const Eigen::Vector3d& place,
                const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ()) {
  Similarity result;
  result.scale = scale;
  result.rotation = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  result.translation = place - scale * (result.rotation * kCentre);
  return result;
}

GrownCluster largest(const std::vector<Similarity>& poses) {
  return largest_grown_cluster(poses, kCentre, kDiagonal, {});
}

TEST(LargestGrownCluster, OfNothingIsNothing) {
  EXPECT_EQ(largest({}).members, 0);
}

TEST(LargestGrownCluster, IsTheLargerGroupAndItsMean) {
  std::vector<Similarity> poses;
  for (const double d : {-1.0, 0.0, 1.0}) poses.push_back(pose(1, 0.02 * d, {0.01 * d, 0, 0}));
  for (const double d : {-2.0, -1.0, 0.0, 1.0, 2.0})
    poses.push_back(pose(2 * std::exp(0.01 * d), 2 + 0.02 * d, {5, 0.01 * d, 0}));
  const GrownCluster cluster = largest(poses);
  EXPECT_EQ(cluster.members, 5);
  EXPECT_NEAR(cluster.pose.scale, 2, 1e-9);
  EXPECT_LT((cluster.pose.apply(kCentre) - Eigen::Vector3d(5, 0, 0)).norm(), 1e-9);
  EXPECT_LT((cluster.pose.rotation - pose(1, 2, kOrigin).rotation).norm(), 1e-9);
}

TEST(LargestGrownCluster, KeepsApartWhatDiffersInOneParameterOnly) {
  // Tolerances: 0.2 in log scale, 0.1 diagonals, 0.3 radians.
  const Similarity first = pose(1, 0, kOrigin);
  const auto together = [&](const Similarity& second) { return largest({first, second}).members; };
  EXPECT_EQ(together(pose(std::exp(0.19), 0, kOrigin)), 2);
  EXPECT_EQ(together(pose(std::exp(0.21), 0, kOrigin)), 1);
  EXPECT_EQ(together(pose(1, 0, {0.19, 0, 0})), 2);
  EXPECT_EQ(together(pose(1, 0, {0.21, 0, 0})), 1);
  EXPECT_EQ(together(pose(1, 0.29, kOrigin)), 2);
  EXPECT_EQ(together(pose(1, 0.31, kOrigin)), 1);
}

TEST(LargestGrownCluster, TakesAQuaternionAndItsNegativeForOneRotation) {
  // About whatever axis and angle the one becomes the other, it is on this way.
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, -1),
                                      Eigen::Vector3d(-1, 0.1, 0.2).normalized()})
    for (int step = 0; step < 126; ++step) {
      const double angle = 0.05 * step;
      const GrownCluster cluster =
          largest({pose(1, angle - 0.05, kOrigin, axis), pose(1, angle + 0.05, kOrigin, axis)});
      EXPECT_EQ(cluster.members, 2);
      EXPECT_LT((cluster.pose.rotation - pose(1, angle, kOrigin, axis).rotation).norm(), 1e-9);
    }
}

TEST(LargestGrownCluster, GrowsWithItsCentre) {
  // Each within reach of the mean of those before it, the last one not of the first.
  std::vector<Similarity> chain;
  double sum = 0;
  for (int i = 0; i < 8; ++i) {
    const double place = i == 0 ? 0.0 : sum / i + 0.19;
    chain.push_back(pose(1, 0, {place, 0, 0}));
    sum += place;
  }
  EXPECT_GT((chain.back().apply(kCentre) - chain.front().apply(kCentre)).norm(), 0.3);
  EXPECT_EQ(largest(chain).members, 8);
  // Also if those that fit only later come first.
  std::vector<Similarity> mixed = {chain[0], chain[7], chain[6], chain[5],
                                   chain[4], chain[3], chain[2], chain[1]};
  EXPECT_EQ(largest(mixed).members, 8);
}

TEST(LargestGrownCluster, MeasuresPlacesInDiagonalsOfThePosedModel) {
  EXPECT_EQ(largest({pose(10, 0, kOrigin), pose(10, 0, {1.9, 0, 0})}).members, 2);
  EXPECT_EQ(largest({pose(10, 0, kOrigin), pose(10, 0, {2.1, 0, 0})}).members, 1);
}

}  // namespace
}  // namespace semigeo::kernels
