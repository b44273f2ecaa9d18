#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "kernels/patch/geodesic.hpp"
#include "kernels/repair/remeshing.hpp"
#include "kernels/repair/surface_builder.hpp"
#include "kernels/surface/vertex_order.hpp"
#include "tests/support/soundness.hpp"

namespace semigeo::tests {

/// Returns a mesh as level 0 is before its first smoothing, in Z-order.
inline kernels::LevelMesh level_mesh(kernels::TriangleMesh mesh) {
  using namespace kernels;
  LevelMesh result;
  const Surface built = build_surface(std::move(mesh)).surface;
  const Surface surface = reordered(built, locality_order(built));
  result.connectivity = surface;
  result.part = surface.part;
  result.part_count = surface.part_count;
  for (const auto& p : surface.points) result.points.push_back({p.x(), p.y(), p.z(), 0});
  for (std::int32_t v = 0; v < surface.vertex_count(); ++v)
    result.normals.push_back(angle_weighted_normal(surface, result.points, v));
  result.initial_points = surface.points;
  result.source.resize(result.points.size());
  std::iota(result.source.begin(), result.source.end(), 0);
  return result;
}

/// Expects what holds for the mesh of every level.
inline void expect_sound(const kernels::LevelMesh& mesh) {
  using namespace kernels;
  EXPECT_EQ(fault_of(mesh.connectivity), "");
  const std::size_t n = mesh.points.size();
  EXPECT_EQ(mesh.connectivity.outgoing.size(), n);
  EXPECT_EQ(mesh.normals.size(), n);
  EXPECT_EQ(mesh.source.size(), n);
  EXPECT_EQ(mesh.initial_points.size(), n);
  ASSERT_EQ(mesh.part.size(), n);
  for (const auto h : mesh.connectivity.outgoing) EXPECT_NE(h, kNone);
  // Parts as they are after any numbering anew, one range of vertices and of faces each.
  std::vector<std::int32_t> numbered;
  EXPECT_EQ(number_parts(mesh.connectivity, numbered), mesh.part_count);
  EXPECT_EQ(numbered, mesh.part);
  EXPECT_TRUE(std::ranges::is_sorted(mesh.part));
  std::vector<std::int32_t> part_of_face;
  for (const auto& t : mesh.connectivity.triangles) part_of_face.push_back(mesh.part[t[0]]);
  EXPECT_TRUE(std::ranges::is_sorted(part_of_face));
}

}  // namespace semigeo::tests
