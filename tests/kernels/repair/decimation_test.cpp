#include "kernels/repair/decimation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "kernels/repair/hole_filling.hpp"
#include "kernels/repair/surface_builder.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/soundness.hpp"

namespace semigeo::kernels {
namespace {

using tests::fault_of;

Surface built(TriangleMesh mesh) {
  return build_surface(std::move(mesh)).surface;
}

double area(const Surface& s) {
  double sum = 0;
  for (const auto& t : s.triangles) {
    const Eigen::Vector3d a = s.points[t[0]].cast<double>();
    sum +=
        0.5 * (s.points[t[1]].cast<double>() - a).cross(s.points[t[2]].cast<double>() - a).norm();
  }
  return sum;
}

/// Sound, and made of the input's vertices, parts and boundary loops.
void expect_sound(const Surface& before, const DecimatedSurface& after) {
  const Surface& s = after.surface;
  EXPECT_EQ(fault_of(s), "");
  ASSERT_EQ(after.source_vertex.size(), s.points.size());
  EXPECT_TRUE(std::is_sorted(after.source_vertex.begin(), after.source_vertex.end()));
  for (std::size_t v = 0; v < s.points.size(); ++v)
    EXPECT_EQ(s.points[v], before.points[after.source_vertex[v]]);
  EXPECT_EQ(after.removed_vertices, before.vertex_count() - s.vertex_count());
  EXPECT_EQ(after.removed_faces, before.face_count() - s.face_count());
  EXPECT_EQ(s.part_count, before.part_count);
  EXPECT_EQ(boundary_loops(s).size(), boundary_loops(before).size());
}

/// What `decimate` says of its distance is what any other measurement finds.
void expect_measured(const Surface& before, const DecimatedSurface& after) {
  const NearestSurface nearest(after.surface);
  const DistanceSummary found = distances(nearest, before.points);
  EXPECT_EQ(after.distance.count, found.count);
  EXPECT_NEAR(after.distance.maximum, found.maximum, 1e-6);
  EXPECT_NEAR(after.distance.mean(), found.mean(), 1e-6);
}

TEST(DecimationTest, APlaneIsReducedToItsCorners) {
  const Surface plane = built(shapes::plane(2, 20));
  const DecimatedSurface result = decimate(plane, {.tolerance = 1e-4});
  expect_sound(plane, result);
  EXPECT_EQ(result.surface.vertex_count(), 4);
  EXPECT_NEAR(area(result.surface), 4, 1e-6);
  EXPECT_LT(result.distance.maximum, 1e-6);
}

TEST(DecimationTest, ACubeKeepsItsEdgesAndCorners) {
  const Surface cube = built(shapes::cube(1, 8));
  const DecimatedSurface result = decimate(cube, {.tolerance = 1e-3});
  expect_sound(cube, result);
  const auto on_edge = [](const Eigen::Vector3f& p) {
    int sides = 0;
    for (int c = 0; c < 3; ++c) sides += std::abs(std::abs(p[c]) - 0.5f) < 1e-6f;
    return sides >= 2;
  };
  EXPECT_EQ(std::count_if(result.surface.points.begin(), result.surface.points.end(), on_edge),
            8 + 12 * 7);
  EXPECT_LT(result.surface.vertex_count(), 8 + 12 * 7 + 6);
  EXPECT_NEAR(area(result.surface), 6, 1e-4);
}

TEST(DecimationTest, ASphereStaysWithinTheTolerance) {
  const Surface sphere = built(shapes::icosphere(5));
  std::int64_t last = sphere.vertex_count();
  for (const double tolerance : {1e-4, 1e-3, 1e-2}) {
    const DecimatedSurface result = decimate(sphere, {.tolerance = tolerance});
    expect_sound(sphere, result);
    expect_measured(sphere, result);
    EXPECT_LE(result.distance.maximum, tolerance * 1.0001);
    EXPECT_LE(result.surface.vertex_count(), last);
    last = result.surface.vertex_count();
  }
  EXPECT_LT(last, sphere.vertex_count() / 10);
}

TEST(DecimationTest, ACylinderKeepsItsRims) {
  const Surface tube = built(shapes::cylinder(1, 4, 48, 40));
  // Every rim vertex is 0.0086 away from the line between its neighbours, those between the rims
  // somewhat less from the average plane of theirs.
  const DecimatedSurface result = decimate(tube, {.tolerance = 0.008});
  expect_sound(tube, result);
  expect_measured(tube, result);
  EXPECT_LE(result.distance.maximum, 0.0080001);
  EXPECT_LE(result.surface.vertex_count(), tube.vertex_count() / 2);
  for (const double z : {-2.0, 2.0})
    EXPECT_EQ(std::count_if(result.surface.points.begin(), result.surface.points.end(),
                            [&](const auto& p) { return std::abs(p.z() - z) < 1e-6; }),
              48);
}

TEST(DecimationTest, ABoundaryThatIsStraightEnoughIsShortened) {
  const Surface tube = built(shapes::cylinder(1, 4, 48, 40));
  const DecimatedSurface result = decimate(tube, {.tolerance = 0.05});
  expect_sound(tube, result);
  for (const double z : {-2.0, 2.0}) {
    const auto rim = std::count_if(result.surface.points.begin(), result.surface.points.end(),
                                   [&](const auto& p) { return std::abs(p.z() - z) < 1e-6; });
    // A rim of n edges bulges by 1 - cos(pi / n).
    EXPECT_GE(rim, 10);
    EXPECT_LE(rim, 36);
  }
}

TEST(DecimationTest, StopsAtTheTarget) {
  const Surface torus = built(shapes::torus(2, 0.7, 90, 40));
  const DecimatedSurface result = decimate(torus, {.target_vertices = 1000});
  expect_sound(torus, result);
  expect_measured(torus, result);
  EXPECT_EQ(result.surface.vertex_count(), 1000);
  EXPECT_LT(result.distance.maximum, 0.02);
  // Normals still point out of the tube.
  for (const auto& t : result.surface.triangles) {
    const auto& p = result.surface.points;
    const Eigen::Vector3f middle = (p[t[0]] + p[t[1]] + p[t[2]]) / 3;
    const Eigen::Vector3f ring = Eigen::Vector3f(middle.x(), middle.y(), 0).normalized() * 2;
    EXPECT_GT((p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).dot(middle - ring), 0);
  }
}

TEST(DecimationTest, BothLimitsHold) {
  const Surface sphere = built(shapes::icosphere(4));
  const DecimatedSurface few = decimate(sphere, {.tolerance = 1, .target_vertices = 2000});
  EXPECT_EQ(few.surface.vertex_count(), 2000);
  const DecimatedSurface near = decimate(sphere, {.tolerance = 1e-3, .target_vertices = 10});
  EXPECT_GT(near.surface.vertex_count(), 100);
  EXPECT_LE(near.distance.maximum, 1.0001e-3);
}

TEST(DecimationTest, NoPartVanishes) {
  TriangleMesh many = shapes::icosphere(2);
  const auto add = [&many](const TriangleMesh& mesh, double x) {
    const auto offset = static_cast<std::int32_t>(many.points.size());
    for (const auto& p : mesh.points) many.points.push_back(p + Eigen::Vector3d(x, 0, 0));
    for (const auto& t : mesh.triangles)
      many.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  };
  add(shapes::torus(1, 0.3, 20, 12), 4);
  add(shapes::plane(1, 4), 8);
  add(shapes::cylinder(0.5, 1, 12, 4), 12);
  add({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, 16);
  add({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}},
      20);
  const Surface before = built(std::move(many));
  const DecimatedSurface result = decimate(before, {.target_vertices = 1});
  expect_sound(before, result);
  EXPECT_LT(result.surface.vertex_count(), 100);
}

TEST(DecimationTest, NoisySheetsWithHolesStaySound) {
  TriangleMesh mesh = shapes::saddle(2, 40, 0.5);
  std::erase_if(mesh.triangles, [&](const auto& t) {
    const auto& p = mesh.points[t[0]];
    return std::hypot(p.x() - 0.3, p.y()) < 0.2 || std::hypot(p.x() + 0.5, p.y() - 0.4) < 0.1;
  });
  shapes::add_noise(mesh, 0.01, 11);
  const Surface before = built(std::move(mesh));
  for (const double tolerance : {0.005, 0.02, 0.1}) {
    const DecimatedSurface result = decimate(before, {.tolerance = tolerance});
    expect_sound(before, result);
    expect_measured(before, result);
    EXPECT_LE(result.distance.maximum, 1.0001 * tolerance);
    EXPECT_GT(result.removed_vertices, 100);
  }
}

TEST(DecimationTest, NothingToDo) {
  const Surface sphere = built(shapes::icosphere(2));
  const DecimatedSurface same = decimate(sphere, {.tolerance = 0});
  EXPECT_EQ(same.surface.triangles, sphere.triangles);
  EXPECT_EQ(same.distance.maximum, 0);
  EXPECT_EQ(same.distance.count, sphere.vertex_count());
  EXPECT_EQ(decimate(sphere, {.target_vertices = 162}).removed_vertices, 0);
}

}  // namespace
}  // namespace semigeo::kernels
