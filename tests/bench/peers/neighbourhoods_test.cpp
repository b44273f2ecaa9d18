#include "bench/peers/neighbourhoods.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "kernels/repair/surface_builder.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::peers {
namespace {

kernels::Surface surface_of(kernels::TriangleMesh mesh) {
  return kernels::build_surface(std::move(mesh)).surface;
}

TEST(Neighbourhoods, RingsAreWhole) {
  const kernels::Surface sphere = surface_of(shapes::icosphere(3));
  Neighbourhoods neighbourhoods(sphere);
  for (std::int32_t v = 0; v < sphere.vertex_count(); ++v) {
    EXPECT_EQ(neighbourhoods.rings(v, 1).size(), 1);
    const auto one = neighbourhoods.rings(v, 2).size();
    EXPECT_TRUE(one == 6 || one == 7);
    const auto two = neighbourhoods.rings(v, one + 1);
    EXPECT_GE(two.size(), 16);
    EXPECT_LE(two.size(), 19);
    EXPECT_EQ(two.front(), v);
    EXPECT_EQ(std::set(two.begin(), two.end()).size(), two.size());
  }
  EXPECT_EQ(neighbourhoods.rings(0, 100'000).size(), sphere.points.size());
}

TEST(Neighbourhoods, BallsHoldAllThatIsNear) {
  const kernels::Surface sphere = surface_of(shapes::icosphere(3));
  Neighbourhoods neighbourhoods(sphere);
  for (std::int32_t v = 0; v < sphere.vertex_count(); v += 50) {
    const auto near = std::ranges::count_if(sphere.points, [&](const Eigen::Vector3f& p) {
      return (p - sphere.points[v]).norm() <= 0.5f;
    });
    EXPECT_EQ(static_cast<std::ptrdiff_t>(neighbourhoods.ball(v, 0.5, 1).size()), near);
    EXPECT_GE(neighbourhoods.ball(v, 1e-3, 15).size(), 15);
  }
}

TEST(Neighbourhoods, ABallKeepsToItsSideOfTheSurface) {
  kernels::TriangleMesh two = shapes::plane(2, 4);
  const auto count = static_cast<std::int32_t>(two.points.size());
  for (std::int32_t i = 0; i < count; ++i)
    two.points.emplace_back(two.points[i] + Eigen::Vector3d(0, 0, 0.1));
  const auto faces = two.triangles.size();
  for (std::size_t f = 0; f < faces; ++f) {
    const auto t = two.triangles[f];
    two.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
  }
  const kernels::Surface sheets = surface_of(std::move(two));
  EXPECT_EQ(Neighbourhoods(sheets).ball(0, 10, 1).size(), static_cast<std::size_t>(count));
}

TEST(EdgesToBoundary, AreCounted) {
  const kernels::Surface plane = surface_of(shapes::plane(8, 8));
  const std::vector<int> edges = edges_to_boundary(plane, 3);
  for (std::int32_t v = 0; v < plane.vertex_count(); ++v) {
    const Eigen::Vector3f& p = plane.points[v];
    const float inside = 4 - std::max(std::abs(p.x()), std::abs(p.y()));
    EXPECT_EQ(edges[v], std::min(3, static_cast<int>(std::lround(inside))));
  }
  EXPECT_EQ(std::ranges::count(edges_to_boundary(surface_of(shapes::icosphere(2)), 5), 5), 162);
}

}  // namespace
}  // namespace semigeo::peers
