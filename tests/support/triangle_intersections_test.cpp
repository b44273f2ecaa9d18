#include "tests/support/triangle_intersections.hpp"

#include <gtest/gtest.h>

#include "tests/support/shapes.hpp"

namespace semigeo::tests {
namespace {

using kernels::TriangleMesh;

TriangleMesh pair(const Eigen::Vector3d& shift) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, -1}, {0.3, 0.2, 1}, {0.2, 2, 1}},
                    {{0, 1, 2}, {3, 4, 5}}};
  for (int i = 3; i < 6; ++i) mesh.points[i] += shift;
  return mesh;
}

TEST(TriangleIntersectionsTest, CountsPairsThatPassThroughEachOther) {
  EXPECT_EQ(count_intersections(pair({0, 0, 0})), 1);
  EXPECT_EQ(count_intersections(pair({0, 0, 1})), 0);  // a corner touches the other's plane
  EXPECT_EQ(count_intersections(pair({0, 0, 2})), 0);
  EXPECT_EQ(count_intersections(pair({2, 0, 0})), 0);
}

TEST(TriangleIntersectionsTest, NeighboursAndCoversInOnePlaceDoNotCount) {
  TriangleMesh mesh = shapes::icosphere(3);
  EXPECT_EQ(count_intersections(mesh), 0);
  const auto first = static_cast<std::int32_t>(mesh.points.size());
  TriangleMesh other = mesh;
  mesh.points.insert(mesh.points.end(), other.points.begin(), other.points.end());
  for (const auto& [a, b, c] : other.triangles)
    mesh.triangles.push_back({a + first, c + first, b + first});
  EXPECT_EQ(count_intersections(mesh), 0);
  for (std::int32_t v = 0; v < first; ++v) mesh.points[v] += Eigen::Vector3d(0.3, 0.05, 0.02);
  EXPECT_GT(count_intersections(mesh), 20);
}

}  // namespace
}  // namespace semigeo::tests
