#include "kernels/repair/coarsening.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "kernels/surface/circulators.hpp"
#include "tests/kernels/repair/level_meshes.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/soundness.hpp"

namespace semigeo::kernels {
namespace {

using Eigen::Vector3d;
using tests::euler_characteristic;
using tests::expect_sound;
using tests::level_mesh;

double mean_edge_length(const LevelMesh& mesh) {
  double sum = 0;
  int count = 0;
  for (const std::int32_t h : edges(mesh.connectivity)) {
    sum += std::sqrt(mesh.length2(h));
    ++count;
  }
  return sum / count;
}

/// Coarsens all parts to one length.
RemeshCounts coarsen_to(LevelMesh& mesh, double length) {
  return coarsen(mesh, std::vector<double>(mesh.part_count, length));
}

Vector3d normal_of(const LevelMesh& mesh, std::int32_t f) {
  const auto& [a, b, c] = mesh.connectivity.triangles[f];
  return (mesh.point(b) - mesh.point(a)).cross(mesh.point(c) - mesh.point(a));
}

double area_of(const LevelMesh& mesh) {
  double area = 0;
  for (std::int32_t f = 0; f < mesh.connectivity.face_count(); ++f)
    area += normal_of(mesh, f).norm() / 2;
  return area;
}

int boundary_loops(const LevelMesh& mesh) {
  const Connectivity& surface = mesh.connectivity;
  std::vector<std::uint8_t> seen(surface.vertex_count());
  int loops = 0;
  for (std::int32_t v = 0; v < surface.vertex_count(); ++v) {
    if (seen[v] != 0 || !surface.on_boundary(v)) continue;
    ++loops;
    for (std::int32_t at = v; seen[at] == 0; at = surface.target(surface.outgoing[at]))
      seen[at] = 1;
  }
  return loops;
}

/// Expects that every vertex has kept all that it carried.
void expect_survivors_of(const LevelMesh& before, const LevelMesh& after) {
  std::map<std::int32_t, std::int32_t> row;
  for (std::int32_t v = 0; v < before.vertex_count(); ++v) row[before.source[v]] = v;
  std::int32_t last = -1;
  for (std::int32_t v = 0; v < after.vertex_count(); ++v) {
    const std::int32_t was = row.at(after.source[v]);
    EXPECT_GT(was, last) << "out of order";
    last = was;
    ASSERT_EQ(after.points[v], before.points[was]);
    ASSERT_EQ(after.normals[v], before.normals[was]);
    ASSERT_EQ(after.initial_points[v], before.initial_points[was]);
    ASSERT_EQ(after.part[v], before.part[was]);
  }
}

// From level to level the length grows by sqrt 2.
TEST(CoarseningTest, ClosedSurfacesGetTheLengthAndKeepTheirGenus) {
  for (const TriangleMesh& shape : {shapes::icosphere(5), shapes::torus(1, 0.4, 160, 64),
                                    shapes::torus(1, 0.4, 160, 64, 0.5)}) {
    LevelMesh mesh = level_mesh(shape);
    const double first = mean_edge_length(mesh);
    const auto genus = euler_characteristic(mesh.connectivity);
    for (double factor = std::sqrt(2.0); factor < 6; factor *= std::sqrt(2.0)) {
      const LevelMesh before = mesh;
      const RemeshCounts counts = coarsen_to(mesh, factor * first);
      EXPECT_EQ(counts.removed, before.vertex_count() - mesh.vertex_count());
      EXPECT_EQ(counts.collapsed, counts.removed);
      EXPECT_NEAR(mean_edge_length(mesh) / (factor * first), 1.05, 0.06) << factor;
      EXPECT_EQ(euler_characteristic(mesh.connectivity), genus);
      EXPECT_EQ(boundary_loops(mesh), 0);
      expect_sound(mesh);
      expect_survivors_of(before, mesh);
    }
  }
}

TEST(CoarseningTest, FacesAreNeitherNeedlesNorTurned) {
  LevelMesh mesh = level_mesh(shapes::torus(1, 0.4, 240, 96, 0.3));
  coarsen_to(mesh, 2 * mean_edge_length(mesh));
  for (std::int32_t f = 0; f < mesh.connectivity.face_count(); ++f) {
    const Vector3d normal = normal_of(mesh, f);
    double longest2 = 0;
    for (int i = 0; i < 3; ++i) {
      longest2 = std::max(longest2, mesh.length2(halfedge(f, i)));
      const Eigen::Vector3f& n = mesh.normals[mesh.connectivity.triangles[f][i]];
      EXPECT_GT(normal.normalized().dot(n.cast<double>()), 0.5);
    }
    EXPECT_GT(normal.norm() / longest2, 0.2);
  }
  // Nearly all edges are Delaunay edges: opposite angles sum to less than 180 degrees.
  int edges_seen = 0, too_wide = 0;
  for (const std::int32_t h : edges(mesh.connectivity)) {
    double sum = 0;
    for (const std::int32_t g : {h, mesh.connectivity.twin[h]}) {
      const Vector3d apex = mesh.point(mesh.connectivity.origin(prev(g)));
      const Vector3d a = mesh.point(mesh.connectivity.origin(g)) - apex;
      const Vector3d b = mesh.point(mesh.connectivity.target(g)) - apex;
      sum += std::atan2(a.cross(b).norm(), a.dot(b));
    }
    ++edges_seen;
    too_wide += sum > 1.02 * std::numbers::pi;
  }
  EXPECT_LT(too_wide, edges_seen / 100);
}

// What is fine is coarsened, what is coarse already stays.
TEST(CoarseningTest, AnUnevenMeshBecomesEven) {
  LevelMesh mesh = level_mesh(shapes::torus(1, 0.4, 240, 96, 0.8));
  const auto unevenness = [&mesh] {
    std::vector<double> lengths;
    for (const std::int32_t h : edges(mesh.connectivity)) lengths.push_back(mesh.length2(h));
    std::sort(lengths.begin(), lengths.end());
    return std::sqrt(lengths[lengths.size() * 95 / 100] / lengths[lengths.size() * 5 / 100]);
  };
  EXPECT_GT(unevenness(), 7);
  coarsen_to(mesh, 3 * mean_edge_length(mesh));
  EXPECT_LT(unevenness(), 3);
  expect_sound(mesh);
}

TEST(CoarseningTest, RimsStayWhereTheyAre) {
  LevelMesh tube = level_mesh(shapes::cylinder(1, 3, 120, 60));
  const auto rim_vertices = [](const LevelMesh& mesh) {
    std::int64_t count = 0;
    for (std::int32_t v = 0; v < mesh.vertex_count(); ++v)
      count += mesh.connectivity.on_boundary(v);
    return count;
  };
  const std::int64_t before = rim_vertices(tube);
  coarsen_to(tube, 0.15);
  expect_sound(tube);
  EXPECT_EQ(boundary_loops(tube), 2);
  EXPECT_EQ(euler_characteristic(tube.connectivity), 0);
  EXPECT_LT(rim_vertices(tube), before / 2);
  for (std::int32_t v = 0; v < tube.vertex_count(); ++v)
    if (tube.connectivity.on_boundary(v)) {
      EXPECT_NEAR(std::abs(tube.point(v).z()), 1.5, 1e-6);
    }

  LevelMesh square = level_mesh(shapes::plane(2, 40));
  coarsen_to(square, 0.2);
  expect_sound(square);
  EXPECT_EQ(boundary_loops(square), 1);
  EXPECT_NEAR(area_of(square), 4, 1e-5);  // corners stay
  EXPECT_NEAR(mean_edge_length(square), 0.2, 0.04);
}

TEST(CoarseningTest, PartsHaveTheirOwnLengths) {
  TriangleMesh shape = shapes::icosphere(4);
  const auto first = static_cast<std::int32_t>(shape.points.size());
  const TriangleMesh other = shape;
  for (const Vector3d& p : other.points) shape.points.push_back(p + Vector3d(3, 0, 0));
  for (const auto& [a, b, c] : other.triangles)
    shape.triangles.push_back({a + first, b + first, c + first});
  LevelMesh mesh = level_mesh(shape);
  ASSERT_EQ(mesh.part_count, 2);
  const double edge = mean_edge_length(mesh);
  const LevelMesh before = mesh;
  coarsen(mesh, std::vector<double>{0, 2 * edge});
  expect_sound(mesh);
  expect_survivors_of(before, mesh);
  EXPECT_EQ(std::ranges::count(mesh.part, 0), first);
  EXPECT_LT(std::ranges::count(mesh.part, 1), 0.3 * first);
  EXPECT_EQ(coarsen(mesh, std::vector<double>{0, 0}), RemeshCounts{});
}

TEST(CoarseningTest, MarksStayWhereTheyAre) {
  LevelMesh mesh = level_mesh(shapes::icosphere(5));
  for (std::int32_t v = 0; v < mesh.vertex_count(); ++v)
    mesh.vertex_filled.push_back(mesh.point(v).z() > 0);
  for (const auto& [a, b, c] : mesh.connectivity.triangles)
    mesh.face_filled.push_back(mesh.point(a).z() + mesh.point(b).z() + mesh.point(c).z() > 0);
  const double length = 2 * mean_edge_length(mesh);
  coarsen_to(mesh, length);
  ASSERT_EQ(static_cast<std::int64_t>(mesh.vertex_filled.size()), mesh.vertex_count());
  ASSERT_EQ(mesh.face_filled.size(), mesh.connectivity.triangles.size());
  for (std::int32_t v = 0; v < mesh.vertex_count(); ++v)
    EXPECT_EQ(mesh.vertex_filled[v] != 0, mesh.point(v).z() > 0);
  for (std::size_t f = 0; f < mesh.face_filled.size(); ++f) {
    const auto& [a, b, c] = mesh.connectivity.triangles[f];
    const double z = (mesh.point(a).z() + mesh.point(b).z() + mesh.point(c).z()) / 3;
    if (std::abs(z) > length) {
      EXPECT_EQ(mesh.face_filled[f] != 0, z > 0);
    }
  }
}

// Nothing is left to describe a surface whose edges are as long as it is, but it stays a surface.
TEST(CoarseningTest, NothingVanishes) {
  for (const TriangleMesh& shape : {shapes::icosphere(0), shapes::icosphere(2), shapes::cube(1, 1),
                                    shapes::plane(1, 3), shapes::torus(1, 0.1, 24, 6)}) {
    LevelMesh mesh = level_mesh(shape);
    const auto genus = euler_characteristic(mesh.connectivity);
    const int loops = boundary_loops(mesh);
    coarsen_to(mesh, 100);
    expect_sound(mesh);
    EXPECT_EQ(euler_characteristic(mesh.connectivity), genus);
    EXPECT_EQ(boundary_loops(mesh), loops);
    EXPECT_EQ(mesh.part_count, 1);
  }
}

// Each of its neighbours could be joined to the hub after a look at all the others.
TEST(CoarseningTest, AHubCostsNoMoreThanItsSpokes) {
  constexpr std::int32_t kSpokes = 200'000;
  TriangleMesh mesh;
  mesh.points.emplace_back(0, 0, 0);
  for (std::int32_t k = 0; k < kSpokes; ++k) {
    const double angle = 2 * std::numbers::pi * k / kSpokes;
    mesh.points.emplace_back(std::cos(angle), std::sin(angle), 0);
    mesh.triangles.push_back({0, k + 1, (k + 1) % kSpokes + 1});
  }
  LevelMesh disc = level_mesh(std::move(mesh));
  coarsen_to(disc, 0.01);
  EXPECT_EQ(tests::fault_of(disc.connectivity), "");
  EXPECT_EQ(boundary_loops(disc), 1);
}

}  // namespace
}  // namespace semigeo::kernels
