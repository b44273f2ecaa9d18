#include "bench/support/mesh_changes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/shapes.hpp"

namespace semigeo::bench {
namespace {

using kernels::TriangleMesh;

TEST(RandomSimilarity, IsARotationAndAFactorBetweenAHalfAndTwo) {
  Random numbers = random(1, 0, "a");
  double smallest = 2, largest = 0.5;
  for (int i = 0; i < 200; ++i) {
    const kernels::Similarity s = random_similarity(3, numbers);
    EXPECT_NEAR(s.rotation.determinant(), 1, 1e-12);
    EXPECT_LT((s.rotation * s.rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    smallest = std::min(smallest, s.scale);
    largest = std::max(largest, s.scale);
    const Eigen::Vector3d p(1, -2, 0.5);
    EXPECT_LT((undo(s, s.apply(p)) - p).norm(), 1e-12);
  }
  EXPECT_GE(smallest, 0.5);
  EXPECT_LT(smallest, 0.55);
  EXPECT_LE(largest, 2);
  EXPECT_GT(largest, 1.8);
}

TEST(Random, FollowsSeedPurposeAndName) {
  EXPECT_EQ(random(1, 0, "a")(), random(1, 0, "a")());
  EXPECT_NE(random(1, 0, "a")(), random(2, 0, "a")());
  EXPECT_NE(random(1, 0, "a")(), random(1, 1, "a")());
  EXPECT_NE(random(1, 0, "a")(), random(1, 0, "b")());
}

TEST(RemoveBall, LeavesItsShareAndNothingWithinTheBall) {
  // On a unit sphere a ball about a vertex is a cap: its share of the area is its height over 2.
  const TriangleMesh whole = shapes::icosphere(4);
  for (const double share : {0.1, 0.5, 0.6, 0.9}) {
    TriangleMesh rest = whole;
    remove_ball(rest, share, random(7, 0, "ball"));
    const double left =
        static_cast<double>(rest.points.size()) / static_cast<double>(whole.points.size());
    EXPECT_LE(left, 1 - share + 1e-3);
    EXPECT_GE(left, 1 - share - 0.02);
    // Faces with a corner inside are gone: about half an edge of rim.
    EXPECT_NEAR(area(rest) / area(whole), 1 - share, 0.05);
    // What is left is a cap as well: all on one side of a plane at height 2 (1 - share) from its
    // pole.
    Eigen::Vector3d pole = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p : rest.points) pole += p;
    pole.normalize();
    for (const Eigen::Vector3d& p : rest.points) EXPECT_GT(p.dot(pole), 2 * share - 1 - 0.1);
  }
}

TEST(RemoveBall, LeavesNoVertexWithoutAFaceAndKeepsIndicesValid) {
  TriangleMesh rest = shapes::torus(1, 0.4, 40, 20);
  remove_ball(rest, 0.6, random(3, 0, "ball"));
  std::vector<int> used(rest.points.size(), 0);
  for (const auto& t : rest.triangles)
    for (const std::int32_t v : t) ++used.at(v);
  EXPECT_EQ(std::ranges::count(used, 0), 0);
}

TEST(MeanEdgeLength, IsThatOfASquaresHalves) {
  const TriangleMesh square{.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                            .triangles = {{0, 1, 2}, {0, 2, 3}}};
  EXPECT_NEAR(mean_edge_length(square), (4 + 2 * std::numbers::sqrt2) / 6, 1e-15);
  EXPECT_NEAR(area(square), 1, 1e-15);
}

TEST(AddNoise, HasItsSigmaInEveryCoordinate) {
  const TriangleMesh before = shapes::icosphere(4);
  TriangleMesh after = before;
  add_noise(after, 0.01, random(1, 0, "noise"));
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (std::size_t v = 0; v < before.points.size(); ++v)
    squares += (after.points[v] - before.points[v]).cwiseAbs2();
  squares /= static_cast<double>(before.points.size());
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(std::sqrt(squares[c]), 0.01, 0.0005);
}

}  // namespace
}  // namespace semigeo::bench
