#include "jobs/report/shown_surface.hpp"

#include <gtest/gtest.h>

#include <limits>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "tests/support/shapes.hpp"

namespace semigeo::jobs {
namespace {

ShownSurface shown(const kernels::TriangleMesh& mesh) {
  ShownSurface surface;
  for (const auto& point : mesh.points) surface.points.push_back(point.cast<float>());
  surface.triangles = mesh.triangles;
  return surface;
}

TEST(ShownSurfaceTest, ASmallSurfaceStaysAsItIs) {
  const ShownSurface sphere = shown(shapes::icosphere(2));
  const ShownSurface same = decimated(sphere, 1000);
  EXPECT_EQ(same.points, sphere.points);
  EXPECT_TRUE(same.rows.empty());
}

TEST(ShownSurfaceTest, VerticesAreRemovedAndNoneIsMoved) {
  const ShownSurface sphere = shown(shapes::icosphere(6));
  for (const std::int64_t most : {20000, 2000, 200}) {  // by decimation alone, and coarsened first
    const ShownSurface small = decimated(sphere, most);
    ASSERT_EQ(small.points.size(), static_cast<std::size_t>(most));
    ASSERT_EQ(small.rows.size(), small.points.size());
    for (std::size_t v = 0; v < small.points.size(); ++v)
      EXPECT_EQ(small.points[v], sphere.points[static_cast<std::size_t>(small.rows[v])]);
    // It is still the sphere: closed, and as large.
    EXPECT_EQ(small.triangles.size(), 2 * small.points.size() - 4);
    double area = 0;
    for (const kernels::Triangle& t : small.triangles)
      area += (small.points[t[1]] - small.points[t[0]])
                  .cross(small.points[t[2]] - small.points[t[0]])
                  .norm() /
              2;
    EXPECT_NEAR(area, 4 * 3.14159, 0.5);
  }
}

TEST(ShownSurfaceTest, FractionsKeepProportions) {
  const std::vector<Eigen::Vector3f> points = {{1, 2, 3}, {3, 2, 3}, {1, 3, 3}};
  const ShownBox box = box_of(points);
  EXPECT_EQ(box.size, 2);
  EXPECT_EQ(fractions(points, box),
            (std::vector<std::uint16_t>{0, 0, 0, 65535, 0, 0, 0, 32768, 0}));
}

TEST(ShownSurfaceTest, PointsThatAreNoNumbersHaveAFraction) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  constexpr float kFar = std::numeric_limits<float>::infinity();
  const ShownBox box = {.low = {0, 0, 0}, .size = 1};
  EXPECT_EQ(fractions({{kNone, kFar, -kFar}}, box), (std::vector<std::uint16_t>{0, 65535, 0}));
  EXPECT_EQ(fractions({{1, 2, 3}}, {.low = {0, 0, 0}, .size = kFar}),
            (std::vector<std::uint16_t>{0, 0, 0}));
}

}  // namespace
}  // namespace semigeo::jobs
