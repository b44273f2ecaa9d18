#include "jobs/stages/prepare_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "kernels/repair/surface_builder.hpp"
#include "kernels/surface/circulators.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::jobs {
namespace {

using kernels::TriangleMesh;

PreparedSurface prepare(TriangleMesh mesh, const PreparationOptions& options, int threads = 2) {
  engine::Workers workers(threads);
  engine::Observer observer;
  return prepare_surface(kernels::build_surface(std::move(mesh)).surface, options,
                         {workers, observer, {}});
}

/// A sphere without the faces about three of its vertices.
TriangleMesh holed_sphere(int levels) {
  TriangleMesh mesh = shapes::icosphere(levels);
  std::erase_if(mesh.triangles, [&](const auto& t) {
    return std::ranges::any_of(t, [](std::int32_t v) { return v == 20 || v == 100 || v == 150; });
  });
  return mesh;
}

std::int64_t boundary_edges(const kernels::Surface& surface) {
  std::int64_t count = 0;
  for (const std::int32_t h : kernels::edges(surface)) count += surface.twin[h] == kernels::kNone;
  return count;
}

TEST(PrepareSurfaceTest, NothingIsDoneUnlessAskedFor) {
  const PreparedSurface prepared = prepare(holed_sphere(3), {});
  EXPECT_EQ(prepared.surface.face_count(), 1280 - 3 * 6);
  EXPECT_TRUE(prepared.vertex_filled.empty() && prepared.face_filled.empty());
  EXPECT_EQ(prepared.result, PreparationResult{});
  EXPECT_EQ(json_of(prepared.result, {}).dump(), "{}");
}

TEST(PrepareSurfaceTest, HolesAreFilledAndMarked) {
  const PreparationOptions options = {.fill_holes = 6};
  const PreparedSurface prepared = prepare(holed_sphere(3), options);
  EXPECT_EQ(prepared.result.holes.loops, 3);
  EXPECT_EQ(prepared.result.holes.filled, 3);
  EXPECT_EQ(boundary_edges(prepared.surface), 0);
  ASSERT_EQ(prepared.vertex_filled.size(), prepared.surface.points.size());
  ASSERT_EQ(prepared.face_filled.size(), prepared.surface.triangles.size());
  EXPECT_EQ(std::ranges::count(prepared.face_filled, 1), prepared.result.filled_faces);
  EXPECT_EQ(prepared.surface.face_count() - prepared.result.filled_faces, 1280 - 3 * 6);
  const nlohmann::json json = json_of(prepared.result, options);
  EXPECT_EQ(json.at("holes_filled"), 3);
  EXPECT_FALSE(json.contains("removed_vertices"));
}

TEST(PrepareSurfaceTest, HolesBeyondTheLimitStay) {
  const PreparedSurface prepared = prepare(holed_sphere(3), {.fill_holes = 5});
  EXPECT_EQ(prepared.result.holes.too_long, 3);
  EXPECT_EQ(boundary_edges(prepared.surface), 18);
}

TEST(PrepareSurfaceTest, DecimationKeepsItsToleranceInEitherUnit) {
  const TriangleMesh mesh = shapes::icosphere(4, 10);
  const double edge = kernels::mean_edge_length(kernels::build_surface(TriangleMesh(mesh)).surface);
  const PreparedSurface relative = prepare(mesh, {.decimate = 0.1});
  const PreparedSurface absolute =
      prepare(mesh, {.decimate = 0.1 * edge, .decimate_in_length_units = true});
  EXPECT_NEAR(relative.result.tolerance, 0.1 * edge, 1e-9);
  EXPECT_EQ(relative.surface.points.size(), absolute.surface.points.size());
  EXPECT_GT(relative.result.removed_vertices, 500);
  EXPECT_EQ(relative.result.distance.count, 2562);
  EXPECT_LE(relative.result.distance.maximum, 0.11 * edge);
  EXPECT_GT(relative.result.distance.mean(), 0);
}

TEST(PrepareSurfaceTest, DecimationReachesItsTargetAndKeepsTheMarks) {
  TriangleMesh mesh = holed_sphere(4);
  const PreparedSurface prepared = prepare(mesh, {.fill_holes = 6, .target_vertices = 1000});
  EXPECT_EQ(prepared.surface.vertex_count(), 1000);
  EXPECT_EQ(boundary_edges(prepared.surface), 0);
  ASSERT_EQ(prepared.face_filled.size(), prepared.surface.triangles.size());
  ASSERT_EQ(prepared.vertex_filled.size(), 1000u);
  // The marked faces lie where the holes were.
  EXPECT_GT(prepared.result.filled_faces, 0);
  for (std::size_t f = 0; f < prepared.face_filled.size(); ++f) {
    Eigen::Vector3f centroid = Eigen::Vector3f::Zero();
    for (const auto v : prepared.surface.triangles[f]) centroid += prepared.surface.points[v] / 3;
    double nearest = 10;
    for (const int v : {20, 100, 150})
      nearest = std::min(nearest, (centroid.cast<double>() - mesh.points[v]).norm());
    if (prepared.face_filled[f] != 0) EXPECT_LT(nearest, 0.2);
    if (nearest < 0.02) EXPECT_EQ(prepared.face_filled[f], 1);
  }
}

TEST(PrepareSurfaceTest, DistancesAndMarksAreThoseOfASearchOverAllFaces) {
  TriangleMesh mesh = holed_sphere(4);
  shapes::add_noise(mesh, 0.01, 1);
  const PreparedSurface before = prepare(mesh, {.fill_holes = 6});
  const PreparedSurface after = prepare(mesh, {.fill_holes = 6, .decimate = 0.1});
  ASSERT_GT(after.result.removed_vertices, 100);

  const kernels::NearestSurface left(after.surface);
  const kernels::DistanceSummary distance = kernels::distances(left, before.surface.points);
  EXPECT_EQ(after.result.distance.count, distance.count);
  EXPECT_EQ(after.result.distance.maximum, distance.maximum);
  EXPECT_EQ(after.result.distance.sum, distance.sum);  // fewer points than a block

  const kernels::NearestSurface all(before.surface);
  for (std::size_t f = 0; f < after.face_filled.size(); ++f) {
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
    for (const auto v : after.surface.triangles[f])
      centroid += after.surface.points[v].cast<double>() / 3;
    EXPECT_EQ(after.face_filled[f], before.face_filled[all.nearest(centroid).face]) << f;
  }
}

TEST(PrepareSurfaceTest, EveryNumberOfThreadsGivesTheSame) {
  const PreparationOptions options = {.fill_holes = 10, .decimate = 0.05};
  const PreparedSurface one = prepare(holed_sphere(4), options, 1);
  for (const int threads : {2, 4}) {
    const PreparedSurface more = prepare(holed_sphere(4), options, threads);
    EXPECT_EQ(one.surface.points, more.surface.points);
    EXPECT_EQ(one.surface.triangles, more.surface.triangles);
    EXPECT_EQ(one.face_filled, more.face_filled);
    EXPECT_EQ(one.result, more.result);
  }
}

}  // namespace
}  // namespace semigeo::jobs
