#include "jobs/bench/surfaces.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "kernels/repair/surface_builder.hpp"

namespace semigeo::jobs {
namespace {

using kernels::TriangleMesh;

kernels::BuiltSurface built(TriangleMesh mesh) {
  return kernels::build_surface(std::move(mesh));
}

struct Edges {
  double shortest = 1e9;
  double longest = 0;
};

Edges edges_of(const TriangleMesh& mesh) {
  Edges edges;
  for (const auto& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) {
      const double length = (mesh.points[t[i]] - mesh.points[t[(i + 1) % 3]]).norm();
      edges.shortest = std::min(edges.shortest, length);
      edges.longest = std::max(edges.longest, length);
    }
  return edges;
}

std::int64_t boundary_vertices(const kernels::Surface& surface) {
  std::int64_t count = 0;
  for (std::int32_t v = 0; v < surface.vertex_count(); ++v) count += surface.on_boundary(v) ? 1 : 0;
  return count;
}

TEST(EvenSphereTest, IsClosedAndEvenAndNeedsNoRepair) {
  const TriangleMesh mesh = even_sphere(1000);
  EXPECT_EQ(mesh.points.size(), 1002U);
  EXPECT_EQ(mesh.triangles.size(), 2000U);  // Euler: F = 2 V - 4
  for (const auto& p : mesh.points) EXPECT_NEAR(p.norm(), 1, 1e-12);
  const Edges edges = edges_of(mesh);
  EXPECT_LT(edges.longest / edges.shortest, 1.7);
  const kernels::BuiltSurface surface = built(mesh);
  EXPECT_EQ(surface.repairs, kernels::SurfaceRepairs{});
  EXPECT_EQ(boundary_vertices(surface.surface), 0);
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    volume += mesh.points[a].dot(mesh.points[b].cross(mesh.points[c])) / 6;
  EXPECT_NEAR(volume, 4.19, 0.05);  // positive: outwards
}

TEST(EvenSphereTest, HasAtLeastTheVerticesAskedFor) {
  EXPECT_EQ(even_sphere(0).points.size(), 12U);
  EXPECT_EQ(even_sphere(12).points.size(), 12U);
  EXPECT_EQ(even_sphere(13).points.size(), 42U);
}

TEST(BoulderTest, TheSeedDecidesTheShape) {
  const TriangleMesh one = boulder(500, 1), again = boulder(500, 1), other = boulder(500, 2);
  EXPECT_EQ(one.points, again.points);
  EXPECT_NE(one.points, other.points);
  EXPECT_EQ(one.triangles, other.triangles);
  EXPECT_EQ(built(one).repairs, kernels::SurfaceRepairs{});
}

TEST(ScanLikeTest, HasARimHolesAndTwoResolutions) {
  const TriangleMesh mesh = scan_like(5000);
  EXPECT_NEAR(static_cast<double>(mesh.points.size()), 5000, 1000);
  EXPECT_EQ(mesh.points, scan_like(5000).points);
  const Edges edges = edges_of(mesh);
  EXPECT_GT(edges.longest / edges.shortest, 6);

  const kernels::BuiltSurface surface = built(mesh);
  EXPECT_EQ(surface.repairs, kernels::SurfaceRepairs{});
  EXPECT_EQ(surface.surface.part_count, 1);
  EXPECT_GT(boundary_vertices(surface.surface), 50);
  // A sphere with four holes has V - E + F = 2 - 4, where 2 E = 3 F + boundary edges.
  const auto vertices = surface.surface.vertex_count(), faces = surface.surface.face_count();
  const auto edge_count = (3 * faces + boundary_vertices(surface.surface)) / 2;
  EXPECT_EQ(vertices - edge_count + faces, -2);

  const auto fine = [&](const Eigen::Vector3d& p) { return p.x() > 0.3; };
  double coarse_length = 0, fine_length = 0;
  std::int64_t coarse_count = 0, fine_count = 0;
  for (const auto& t : mesh.triangles) {
    const double length = (mesh.points[t[0]] - mesh.points[t[1]]).norm();
    (fine(mesh.points[t[0]]) ? fine_length : coarse_length) += length;
    ++(fine(mesh.points[t[0]]) ? fine_count : coarse_count);
  }
  EXPECT_NEAR(coarse_length / static_cast<double>(coarse_count),
              2 * fine_length / static_cast<double>(fine_count),
              0.5 * coarse_length / static_cast<double>(coarse_count));
}

}  // namespace
}  // namespace semigeo::jobs
