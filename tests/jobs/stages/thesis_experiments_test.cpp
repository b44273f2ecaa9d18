/// The diffusion experiments of thesis 6.1, on objects like those in it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/jobs/stages/level_shape.hpp"
#include "tests/support/manifold.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/solids.hpp"

namespace semigeo::jobs {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using kernels::TriangleMesh;

/// The faces whose middle is on the near side of a plane.
TriangleMesh clipped(TriangleMesh mesh, const Vector3d& direction, double offset) {
  std::erase_if(mesh.triangles, [&](const auto& t) {
    const Vector3d sum = mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]];
    return sum.dot(direction) / 3 > offset;
  });
  return mesh;
}

/// Farthest over nearest distance of a level's points from the centre.
double roundness(const EvolvedMesh& evolved, std::size_t level) {
  double nearest = 1e300, farthest = 0;
  for (const Vector3f& p : evolved.levels[level].points) {
    nearest = std::min<double>(nearest, p.norm());
    farthest = std::max<double>(farthest, p.norm());
  }
  return farthest / nearest;
}

// The thesis' cube (6.1, Figure 6.1), 98 vertices: near a sphere after five iterations in either
// coordinates, and the same one within 2 % of the mean edge length.
TEST(ThesisExperimentsTest, ACubeBecomesASphereInBothCoordinates_Figure6_1) {
  const EvolvedMesh a = evolve_mesh(shapes::cube(2, 4), 5);
  const EvolvedMesh b =
      evolve_mesh(shapes::cube(2, 4), 5, {.coordinates = kernels::Coordinates::kPolar});
  ASSERT_EQ(a.levels[0].points.size(), 98u);
  EXPECT_GT(roundness(a, 0), 1.7);
  EXPECT_LT(roundness(a, 5), 1.04);
  EXPECT_LT(roundness(b, 5), 1.02);
  double mean_a = 0, mean_b = 0, difference = 0;
  for (std::size_t v = 0; v < 98; ++v) {
    mean_a += a.point(5, v).norm() / 98;
    mean_b += b.point(5, v).norm() / 98;
  }
  for (std::size_t v = 0; v < 98; ++v)
    difference += std::abs(a.point(5, v).norm() / mean_a * mean_b - b.point(5, v).norm()) / 98;
  const double edge = a.levels[0].mean_edge_length;
  EXPECT_NEAR(mean_a, mean_b, 0.02 * edge);
  EXPECT_LT(difference, 0.02 * edge);
}

/// The first level of more than one part; one behind the last if there is none.
int first_torn(const std::vector<LevelShape>& levels) {
  const auto torn = [](const LevelShape& level) { return level.parts > 1; };
  return static_cast<int>(std::ranges::find_if(levels, torn) - levels.begin());
}

void expect_sound(const EvolvedMesh& evolved, const std::vector<LevelShape>& levels) {
  for (std::size_t k = 0; k < levels.size(); ++k) {
    EXPECT_EQ(tests::why_not_manifold(levels[k].mesh), "") << "level " << k;
    for (std::size_t v = 0; v < levels[k].mesh.points.size(); ++v) {
      ASSERT_TRUE(levels[k].mesh.points[v].allFinite()) << "level " << k;
      ASSERT_TRUE(evolved.levels[k].normals[v].allFinite()) << "level " << k;
      ASSERT_TRUE(std::isfinite(evolved.levels[k].mean_curvature[v])) << "level " << k;
    }
  }
}

/// The objects come apart along x: what is left of x = 0 comes from the left end alone.
void expect_two_ends(const TriangleMesh& mesh, const LevelShape& level) {
  ASSERT_EQ(level.parts, 2);
  std::vector<double> side(2, 0);
  for (std::size_t v = 0; v < level.part.size(); ++v)
    side[level.part[v]] += level.mesh.points[v].x();
  EXPECT_LT(side[0] * side[1], 0);
  std::int64_t descendants = 0;
  for (std::size_t v = 0; v < level.part.size(); ++v) {
    if (level.source[v] < 0) continue;
    ++descendants;
    // Not beyond the middle, but for the neck, which is torn in several places.
    EXPECT_GT(mesh.points[level.source[v]].x() * side[level.part[v]],
              -0.5 * std::abs(side[level.part[v]]));
  }
  EXPECT_GT(descendants, 0.7 * static_cast<double>(mesh.points.size()));
}

// Figure 6.6. From then on each end is a part of its own, and keeps what it encloses.
TEST(ThesisExperimentsTest, DumbbellAndPhoneFallIntoTheirTwoEnds_Figure6_6) {
  const struct {
    const char* name;
    TriangleMesh mesh;
    int from, to;
  } objects[] = {{"dumbbell", shapes::dumbbell(), 5, 8}, {"phone", shapes::phone(), 7, 11}};
  for (const auto& [name, mesh, from, to] : objects) {
    SCOPED_TRACE(name);
    const EvolvedMesh evolved = evolve_mesh(mesh, 30);
    const std::vector<LevelShape> levels = level_shapes(evolved);
    expect_sound(evolved, levels);
    const int torn = first_torn(levels);
    EXPECT_GE(torn, from);
    ASSERT_LE(torn, to);
    for (int k = torn; k <= 30; ++k) EXPECT_GE(levels[k].parts, 2) << "level " << k;
    expect_two_ends(mesh, levels[30]);
    const std::vector<double> before = part_volumes(levels[to]), after = part_volumes(levels[30]);
    for (const double part : after) {
      EXPECT_NEAR(part, volume(levels[30]) / 2, 0.02 * part);
      EXPECT_NEAR(part, volume(levels[to]) / 2, 0.05 * part);
    }
    // Rounder all the time: area falls while the volume stays.
    EXPECT_LT(area(levels[30]), area(levels[to]));
  }
}

TEST(ThesisExperimentsTest, WithoutRemeshingNothingComesApart) {
  for (const TriangleMesh& mesh : {shapes::dumbbell(), shapes::phone(), shapes::chair()})
    for (const LevelFields& level : evolve_mesh(mesh, 20, {.remesh = false}).levels) {
      EXPECT_FALSE(level.connectivity);
      EXPECT_EQ(level.parts, 1);
      EXPECT_EQ(level.points.size(), mesh.points.size());
    }
}

// Figure 6.7. The bars to the back tear first, and the legs shrink into the seat.
TEST(ThesisExperimentsTest, AChairFallsIntoSeatAndBack_Figure6_7) {
  const TriangleMesh mesh = shapes::chair();
  const EvolvedMesh evolved = evolve_mesh(mesh, 12);
  const std::vector<LevelShape> levels = level_shapes(evolved);
  expect_sound(evolved, levels);
  const int torn = first_torn(levels);
  EXPECT_GE(torn, 3);
  EXPECT_LE(torn, 6);
  std::vector<double> volumes = part_volumes(levels[12]);
  std::ranges::sort(volumes, std::greater<>());
  const double all = volume(levels[12]);
  ASSERT_GE(volumes.size(), 2u);
  EXPECT_GT(volumes[1], 0.2 * all);                 // seat and back
  EXPECT_GT(volumes[0] + volumes[1], 0.999 * all);  // and crumbs of bars and legs
  Eigen::AlignedBox3d box;
  for (const auto& p : levels[12].mesh.points) box.extend(p);
  EXPECT_GT(box.min().z(), -0.6);  // legs reached down to -1.1
  EXPECT_GT(box.max().z(), 1.1);
}

/// Ends of edges with one face only.
std::vector<Vector3d> rim_points(const LevelShape& shape) {
  std::vector<Vector3d> points;
  for (const auto& edge : boundary(shape)) points.push_back(shape.mesh.points[edge.first]);
  return points;
}

double farthest_from(const std::vector<Vector3d>& to, const std::vector<Vector3d>& points) {
  double farthest = 0;
  for (const auto& p : points) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& q : to) nearest = std::min(nearest, (p - q).norm());
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

/// Half a phone (Figure 6.9), with a triangle removed on top of the end.
TriangleMesh half_phone_with_hole() {
  TriangleMesh mesh = clipped(shapes::phone(), Vector3d::UnitX(), 0);
  const auto off = [&](const std::array<std::int32_t, 3>& t) {
    return (mesh.points[t[0]] - Vector3d(-1.5, 0, 0.35)).norm();
  };
  mesh.triangles.erase(std::ranges::min_element(mesh.triangles, {}, off));
  return mesh;
}

// Figures 6.8, 6.9, 6.11. A rim is never smoothed away: it moves along with its part.
TEST(ThesisExperimentsTest, PartialScansEvolveWithTheirRims) {
  const struct {
    const char* name;
    TriangleMesh mesh;
  } objects[] = {{"half phone with a hole", half_phone_with_hole()},
                 {"hemisphere", shapes::hemisphere(4)},
                 {"dumbbell cut through a ball", clipped(shapes::dumbbell(), Vector3d::UnitX(), 2)},
                 {"dumbbell cut lengthwise", clipped(shapes::dumbbell(), Vector3d::UnitY(), 0)}};
  for (const auto& [name, mesh] : objects) {
    SCOPED_TRACE(name);
    const EvolvedMesh evolved = evolve_mesh(mesh, 30);
    const std::vector<LevelShape> levels = level_shapes(evolved);
    expect_sound(evolved, levels);
    const std::vector<Vector3d> rim = rim_points(levels[0]);
    const double edge = evolved.levels[0].mean_edge_length;
    for (const LevelShape& level : levels) {
      EXPECT_GT(rim_points(level).size(), 0.8 * static_cast<double>(rim.size()));
      EXPECT_LT(farthest_from(rim, rim_points(level)), 4 * edge);
    }
  }
}

// Figure 6.10: of the seat's lower half, open at the top, only the plate is left; pieces of the
// legs are too small for a patch.
TEST(ThesisExperimentsTest, SmallSegmentsOfAnOpenChairAreDropped_Figure6_10) {
  const EvolvedMesh evolved = evolve_mesh(clipped(shapes::chair(), Vector3d::UnitZ(), 0), 12);
  const std::vector<LevelShape> levels = level_shapes(evolved);
  expect_sound(evolved, levels);
  std::int64_t dropped = 0;
  for (const LevelFields& level : evolved.levels) dropped += level.remeshed.dropped_parts;
  EXPECT_GT(dropped, 0);
  EXPECT_EQ(levels[12].parts, 1);
  EXPECT_GT(rim_points(levels[12]).size(), 0.8 * static_cast<double>(rim_points(levels[0]).size()));
}

}  // namespace
}  // namespace semigeo::jobs
