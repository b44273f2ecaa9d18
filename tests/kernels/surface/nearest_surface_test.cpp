#include "kernels/surface/nearest_surface.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "kernels/repair/surface_builder.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::kernels {
namespace {

Surface built(TriangleMesh mesh) {
  return build_surface(std::move(mesh)).surface;
}

TEST(NearestSurfaceTest, NearestOnATriangleInEachRegion) {
  const Eigen::Vector3d a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
  const auto at = [&](double x, double y, double z) {
    return nearest_on_triangle({x, y, z}, a, b, c);
  };
  EXPECT_TRUE(at(1, 1, 5).isApprox(Eigen::Vector3d(1, 1, 0)));
  EXPECT_TRUE(at(-1, -2, 3).isApprox(a) || at(-1, -2, 3).isZero());
  EXPECT_TRUE(at(6, -1, 1).isApprox(b));
  EXPECT_TRUE(at(-1, 9, 0).isApprox(c));
  EXPECT_TRUE(at(2, -3, 1).isApprox(Eigen::Vector3d(2, 0, 0)));
  EXPECT_TRUE(at(-1, 3, -2).isApprox(Eigen::Vector3d(0, 3, 0)));
  EXPECT_TRUE(at(4, 4, 1).isApprox(Eigen::Vector3d(2, 2, 0)));
}

TEST(NearestSurfaceTest, TrianglesWithoutArea) {
  const Eigen::Vector3d a(0, 0, 0), b(1, 0, 0);
  EXPECT_TRUE(nearest_on_triangle({0.5, 2, 0}, a, b, a).isApprox(Eigen::Vector3d(0.5, 0, 0)));
  EXPECT_TRUE(nearest_on_triangle({3, 2, 0}, b, b, b).isApprox(b));
}

TEST(NearestSurfaceTest, AgreesWithTryingAllFaces) {
  for (Surface surface : {built(shapes::icosphere(3)), built(shapes::saddle(2, 9)),
                          built(shapes::torus(1, 0.3, 23, 11, 0.6))}) {
    const NearestSurface nearest(surface);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> coordinate(-2, 2);
    for (int k = 0; k < 300; ++k) {
      const Eigen::Vector3d p(coordinate(random), coordinate(random), coordinate(random));
      double expected = std::numeric_limits<double>::infinity();
      for (const auto& t : surface.triangles)
        expected =
            std::min(expected, (p - nearest_on_triangle(p, surface.points[t[0]].cast<double>(),
                                                        surface.points[t[1]].cast<double>(),
                                                        surface.points[t[2]].cast<double>()))
                                   .norm());
      const NearestPoint found = nearest.nearest(p);
      ASSERT_DOUBLE_EQ(found.distance, expected);
      ASSERT_NEAR((p - found.point).norm(), expected, 1e-12);
      ASSERT_GE(found.face, 0);
      EXPECT_EQ(nearest.nearest(p, 0.999 * expected).face, kNone);
      EXPECT_EQ(nearest.nearest(p, 1.001 * expected).face, found.face);
    }
  }
}

TEST(NearestSurfaceTest, DistanceFromASphere) {
  const Surface sphere = built(shapes::icosphere(4));
  const NearestSurface nearest(sphere);
  for (const double r : {0.1, 0.9, 1.0, 1.5, 40.0}) {
    const Eigen::Vector3d p = r * Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
    EXPECT_NEAR(nearest.nearest(p).distance, std::abs(r - 1), 1e-3);
  }
}

TEST(NearestSurfaceTest, AVertexIsAtDistanceZero) {
  const Surface sphere = built(shapes::icosphere(3));
  const NearestSurface nearest(sphere);
  const DistanceSummary all = distances(nearest, sphere.points);
  EXPECT_EQ(all.count, sphere.vertex_count());
  EXPECT_LT(all.maximum, 1e-15);
  EXPECT_EQ(nearest.nearest(sphere.points[7].cast<double>(), 1e-12).distance, 0);
}

TEST(NearestSurfaceTest, SummariesOfRangesAddUp) {
  const Surface coarse = built(shapes::icosphere(2));
  const Surface fine = built(shapes::icosphere(4));
  const NearestSurface nearest(coarse);
  const std::span<const Eigen::Vector3f> points = fine.points;
  const DistanceSummary whole = distances(nearest, points);
  DistanceSummary sum = distances(nearest, points.first(100));
  sum.add(distances(nearest, points.subspan(100)));
  EXPECT_EQ(sum.count, whole.count);
  EXPECT_EQ(sum.maximum, whole.maximum);
  EXPECT_NEAR(sum.mean(), whole.mean(), 1e-15);
  // Midpoints of the coarse edges bulge most: 1 - cos of half an edge's angle.
  EXPECT_GT(whole.maximum, 0.005);
  EXPECT_LT(whole.maximum, 0.05);
}

TEST(NearestSurfaceTest, NothingIsNearToNothing) {
  const Surface empty;
  const NearestSurface nearest(empty);
  EXPECT_EQ(nearest.nearest({0, 0, 0}).face, kNone);
  EXPECT_EQ(distances(nearest, {}).mean(), 0);
}

}  // namespace
}  // namespace semigeo::kernels
