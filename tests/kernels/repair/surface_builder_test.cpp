#include "kernels/repair/surface_builder.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <set>

#include "tests/support/shapes.hpp"
#include "tests/support/soundness.hpp"

namespace semigeo::kernels {
namespace {

using tests::fault_of;

TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

TEST(SurfaceBuilderTest, ACleanMeshStaysAsItIs) {
  const auto built = build_surface(tetrahedron());
  EXPECT_EQ(built.repairs, SurfaceRepairs{});
  EXPECT_EQ(built.surface.triangles, tetrahedron().triangles);
  EXPECT_EQ(built.surface.part_count, 1);
  EXPECT_TRUE(built.origin.isZero(0));
  EXPECT_EQ(fault_of(built.surface), "");
}

TEST(SurfaceBuilderTest, WeldsASoupInOrderOfAppearance) {
  TriangleMesh soup;
  for (const auto& t : tetrahedron().triangles) {
    for (const auto v : t) soup.points.push_back(tetrahedron().points[v]);
    const auto n = static_cast<std::int32_t>(soup.points.size());
    soup.triangles.push_back({n - 3, n - 2, n - 1});
  }
  soup.points[4] = -soup.points[4] * 0.0;  // not a corner of the tetrahedron any more, but ...
  soup.points[4] = {1, -0.0, 0};           // ... vertex 1 again, with a negative zero
  const auto built = build_surface(std::move(soup));
  EXPECT_EQ(built.repairs.welded_vertices, 8);
  EXPECT_EQ(built.surface.vertex_count(), 4);
  EXPECT_EQ(built.surface.triangles[0], (std::array<std::int32_t, 3>{0, 1, 2}));
  EXPECT_EQ(fault_of(built.surface), "");
}

TEST(SurfaceBuilderTest, CountsWhatAHalfEdgeMeshCannotHold) {
  TriangleMesh mesh = tetrahedron();
  mesh.points.push_back({5, 5, 5});     // isolated
  mesh.points.push_back({-1, -1, -1});  // third face on edge 0 - 1
  mesh.triangles.push_back({0, 1, 1});  // degenerate
  mesh.triangles.push_back({3, 1, 0});  // duplicate, turned
  mesh.triangles.push_back({0, 1, 5});  // non-manifold
  const auto built = build_surface(std::move(mesh));
  SurfaceRepairs expected;
  expected.degenerate_faces = 1;
  expected.duplicate_faces = 1;
  expected.nonmanifold_faces = 1;
  expected.isolated_vertices = 2;
  EXPECT_EQ(built.repairs, expected);
  EXPECT_EQ(built.surface.triangles, tetrahedron().triangles);
  EXPECT_EQ(fault_of(built.surface), "");
}

TEST(SurfaceBuilderTest, OrientsByMajority) {
  TriangleMesh mesh = shapes::icosphere(2);
  std::int64_t turned = 0;
  for (std::size_t f = 0; f < mesh.triangles.size(); f += 3, ++turned)
    std::swap(mesh.triangles[f][0], mesh.triangles[f][1]);
  const auto built = build_surface(std::move(mesh));
  EXPECT_EQ(built.repairs.flipped_faces, turned);
  EXPECT_EQ(built.repairs.nonmanifold_faces, 0);
  for (const auto& t : built.surface.triangles) {
    const auto& p = built.surface.points;
    EXPECT_GT(p[t[0]].dot(Eigen::Vector3f(p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]])), 0);
  }
}

TEST(SurfaceBuilderTest, SplitsAVertexWhereTwoFansTouch) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}},
                    {{0, 1, 2}, {0, 3, 4}}};
  const auto built = build_surface(std::move(mesh));
  EXPECT_EQ(built.repairs.split_vertices, 1);
  EXPECT_EQ(built.surface.vertex_count(), 6);
  EXPECT_EQ(built.surface.points[5], built.surface.points[0]);
  EXPECT_EQ(built.surface.part_count, 2);
  EXPECT_EQ(built.surface.part, (std::vector<std::int32_t>{0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(fault_of(built.surface), "");
}

TEST(SurfaceBuilderTest, AMoebiusStripIsCutNotRefused) {
  TriangleMesh mesh;
  constexpr int kLength = 12;
  for (int i = 0; i < kLength; ++i) {
    const double s = 2 * M_PI * i / kLength, t = s / 2;
    for (const double w : {-0.3, 0.3})
      mesh.points.emplace_back((1 + w * std::cos(t)) * std::cos(s),
                               (1 + w * std::cos(t)) * std::sin(s), w * std::sin(t));
  }
  for (std::int32_t i = 0; i < kLength; ++i) {
    const std::int32_t a = 2 * i, b = a + 1;
    const bool last = i == kLength - 1;
    const std::int32_t c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({b, c, d});
  }
  const auto built = build_surface(std::move(mesh));
  EXPECT_GE(built.repairs.nonmanifold_faces + built.repairs.flipped_faces, 1);
  EXPECT_GE(built.surface.face_count(), 2 * kLength - 2);
  EXPECT_EQ(fault_of(built.surface), "");
}

TEST(SurfaceBuilderTest, FarFromTheOriginKeepsItsDetail) {
  TriangleMesh mesh = shapes::icosphere(3);
  const Eigen::Vector3d map(432100.25, 5712000.5, 117.75);
  for (auto& p : mesh.points) p += map;
  const auto built = build_surface(std::move(mesh));
  EXPECT_FALSE(built.origin.isZero(0));
  const auto original = shapes::icosphere(3).points;
  for (std::size_t v = 0; v < original.size(); ++v)
    EXPECT_LT((built.surface.points[v].cast<double>() + built.origin - map - original[v]).norm(),
              1e-6);
}

TEST(SurfaceBuilderTest, NothingLeftIsAnEmptySurface) {
  const auto built = build_surface({{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 1}}});
  EXPECT_EQ(built.surface.face_count(), 0);
  EXPECT_EQ(built.surface.vertex_count(), 0);
  EXPECT_EQ(built.repairs.degenerate_faces, 1);
  EXPECT_EQ(built.repairs.isolated_vertices, 2);
}

}  // namespace
}  // namespace semigeo::kernels
