#include "kernels/repair/hole_filling.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "kernels/repair/surface_builder.hpp"
#include "kernels/surface/circulators.hpp"
#include "kernels/surface/nearest_surface.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/soundness.hpp"

namespace semigeo::kernels {
namespace {

using tests::euler_characteristic;
using tests::fault_of;

Surface built(TriangleMesh mesh) {
  return build_surface(std::move(mesh)).surface;
}

/// Without the faces that have a corner where `inside` is true.
Surface punched(TriangleMesh mesh, const std::function<bool(const Eigen::Vector3d&)>& inside) {
  std::erase_if(mesh.triangles, [&](const auto& t) {
    return inside(mesh.points[t[0]]) || inside(mesh.points[t[1]]) || inside(mesh.points[t[2]]);
  });
  return built(std::move(mesh));
}

HoleCounts counts(std::int64_t loops, std::int64_t filled, std::int64_t outer,
                  std::int64_t too_long = 0, std::int64_t unsplittable = 0) {
  return {loops, filled, outer, too_long, unsplittable};
}

bool in_square(const Eigen::Vector3d& p) {
  return std::abs(p.x()) < 0.3 && std::abs(p.y()) < 0.3;
}

TEST(HoleFillingTest, AClosedSurfaceStaysAsItIs) {
  const Surface sphere = built(shapes::icosphere(2));
  const FilledSurface filled = fill_holes(sphere, 100);
  EXPECT_EQ(filled.counts, HoleCounts{});
  EXPECT_EQ(filled.surface.triangles, sphere.triangles);
  EXPECT_EQ(filled.surface.twin, sphere.twin);
}

TEST(HoleFillingTest, ASquareHoleInASheetIsFilledAndItsOutlineLeft) {
  const Surface sheet = punched(shapes::plane(2, 20), in_square);
  const FilledSurface filled = fill_holes(sheet, 1000);
  EXPECT_EQ(filled.counts, counts(2, 1, 1));
  EXPECT_EQ(fault_of(filled.surface), "");
  EXPECT_EQ(euler_characteristic(filled.surface), 1);
  double area = 0;
  for (const auto& t : filled.surface.triangles) {
    const auto& p = filled.surface.points;
    const Eigen::Vector3f n = (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]);
    EXPECT_GT(n.z(), 0);
    area += 0.5 * n.z();
  }
  EXPECT_NEAR(area, 4, 1e-5);
  for (const auto& p : filled.surface.points) EXPECT_NEAR(p.z(), 0, 1e-6);
}

TEST(HoleFillingTest, PatchesAreMarkedAndAsFineAsTheSurface) {
  const Surface sheet = punched(shapes::plane(2, 20), in_square);
  const FilledSurface filled = fill_holes(sheet, 1000);
  const auto old_vertices = sheet.vertex_count();
  ASSERT_EQ(filled.vertex_filled.size(), filled.surface.points.size());
  ASSERT_EQ(filled.face_filled.size(), filled.surface.triangles.size());
  for (std::int64_t v = 0; v < filled.surface.vertex_count(); ++v)
    EXPECT_EQ(filled.vertex_filled[v], v >= old_vertices);
  for (std::int64_t f = 0; f < filled.surface.face_count(); ++f)
    EXPECT_EQ(filled.face_filled[f], f >= sheet.face_count());
  // The hole had 5 x 5 vertices.
  EXPECT_GT(filled.surface.vertex_count(), old_vertices + 12);
  EXPECT_LT(filled.surface.vertex_count(), old_vertices + 50);
  for (std::int64_t f = sheet.face_count(); f < filled.surface.face_count(); ++f) {
    const auto& t = filled.surface.triangles[f];
    for (int i = 0; i < 3; ++i)
      EXPECT_LT((filled.surface.points[t[i]] - filled.surface.points[t[(i + 1) % 3]]).norm(), 0.25);
  }
}

TEST(HoleFillingTest, WithoutRefinementThereAreNoNewVertices) {
  const Surface sheet = punched(shapes::plane(2, 20), in_square);
  const FilledSurface filled = fill_holes(sheet, 1000, {.refine = false});
  EXPECT_EQ(filled.surface.vertex_count(), sheet.vertex_count());
  EXPECT_EQ(filled.surface.face_count(), sheet.face_count() + 24 - 2);
  EXPECT_EQ(fault_of(filled.surface), "");
}

TEST(HoleFillingTest, LoopsWithMoreEdgesThanTheLimitAreLeft) {
  const Surface sheet = punched(shapes::plane(2, 20), in_square);
  EXPECT_EQ(fill_holes(sheet, 23).counts, counts(2, 0, 1, 1));
  EXPECT_EQ(fill_holes(sheet, 24).counts, counts(2, 1, 1));
  EXPECT_EQ(fill_holes(sheet, 0).counts, counts(2, 0, 1, 1));
}

/// Largest distance of new vertices from the unit sphere after a cap has been filled.
double cap_error(int levels) {
  const Surface open =
      punched(shapes::icosphere(levels), [](const auto& p) { return p.z() > std::cos(0.4); });
  const FilledSurface filled = fill_holes(open, 1000);
  EXPECT_EQ(filled.counts, counts(1, 1, 0));
  EXPECT_EQ(euler_characteristic(filled.surface), 2);
  EXPECT_EQ(fault_of(filled.surface), "");
  double error = 0;
  for (std::int64_t v = open.vertex_count(); v < filled.surface.vertex_count(); ++v)
    error = std::max(error, std::abs(filled.surface.points[v].norm() - 1.0));
  return error;
}

TEST(HoleFillingTest, TheFillOfASphereContinuesTheSphere) {
  // A flat lid would lie 0.08 below the sphere. The plate's own error is of fourth order in the
  // width of the hole.
  EXPECT_LT(cap_error(4), 0.01);
  EXPECT_LT(cap_error(5), 0.01);
}

TEST(HoleFillingTest, TheFillOfASaddleContinuesTheSaddle) {
  const Surface open = punched(shapes::saddle(2, 30, 0.8), in_square);
  const FilledSurface filled = fill_holes(open, 1000);
  EXPECT_EQ(filled.counts, counts(2, 1, 1));
  const Surface whole = built(shapes::saddle(2, 60, 0.8));
  const NearestSurface nearest(whole);
  const auto patch = std::span(filled.surface.points).subspan(open.vertex_count());
  EXPECT_GT(patch.size(), 30u);
  EXPECT_LT(distances(nearest, patch).maximum, 2e-3);
}

TEST(HoleFillingTest, NoisyHolesStayWithinTheNoise) {
  TriangleMesh mesh = shapes::icosphere(5);
  const double edge = 0.035;
  shapes::add_noise(mesh, 0.3 * edge, 3);
  const Surface open = punched(mesh, [](const auto& p) {
    return std::abs(p.x()) > 0.97 || std::abs(p.y()) > 0.97 || std::abs(p.z()) > 0.97;
  });
  const FilledSurface filled = fill_holes(open, 1000);
  // Noise leaves a few islands of faces in the holes, and pinches their rims.
  EXPECT_EQ(filled.counts.filled + filled.counts.outer, filled.counts.loops);
  EXPECT_GE(filled.counts.filled, 6);
  EXPECT_EQ(fault_of(filled.surface), "");
  double sum = 0;
  const auto count = filled.surface.vertex_count() - open.vertex_count();
  for (std::int64_t v = open.vertex_count(); v < filled.surface.vertex_count(); ++v)
    sum += std::abs(filled.surface.points[v].norm() - 1.0);
  EXPECT_GT(count, 100);
  EXPECT_LT(sum / static_cast<double>(count), 0.6 * edge);
}

TEST(HoleFillingTest, TheOuterBoundaryOfEachOpenPartIsLeft) {
  EXPECT_EQ(fill_holes(built(shapes::hemisphere(3)), 1000).counts, counts(1, 0, 1));
  // Of a tube's two ends one is the outer boundary.
  EXPECT_EQ(fill_holes(built(shapes::cylinder(1, 3, 24, 9)), 1000).counts, counts(2, 1, 1));
  // A rolled-up sheet that nearly closes has hardly any vector area, yet it is open.
  TriangleMesh scroll = shapes::plane(6, 30);
  for (auto& p : scroll.points) p = {std::cos(p.x()), std::sin(p.x()), p.y()};
  EXPECT_EQ(fill_holes(built(std::move(scroll)), 1000).counts, counts(1, 0, 1));
  // The smallest parts.
  TriangleMesh triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  EXPECT_EQ(fill_holes(built(std::move(triangle)), 1000).counts, counts(1, 0, 1));
}

TEST(HoleFillingTest, APartIsOpenOrClosedByItself) {
  TriangleMesh two = shapes::icosphere(3);
  const auto offset = static_cast<std::int32_t>(two.points.size());
  const TriangleMesh sheet = shapes::plane(2, 20);
  for (const auto& p : sheet.points) two.points.push_back(p + Eigen::Vector3d(5, 0, 0));
  for (const auto& t : sheet.triangles)
    two.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  const Surface open = punched(
      two, [](const auto& p) { return p.z() > 0.97 || in_square(p - Eigen::Vector3d(5, 0, 0)); });
  const FilledSurface filled = fill_holes(open, 1000);
  EXPECT_EQ(filled.counts, counts(3, 2, 1));
  EXPECT_EQ(filled.surface.part_count, 2);
}

TEST(HoleFillingTest, HolesThatTouchInAVertexAreFilledOneByOne) {
  const Surface open = punched(shapes::plane(2, 40), [](const auto& p) {
    const auto near = [&](double x, double y) {
      return std::abs(p.x() - x) < 0.12 && std::abs(p.y() - y) < 0.12;
    };
    return near(0.15, 0.15) || near(-0.15, -0.15);
  });
  const FilledSurface filled = fill_holes(open, 1000);
  EXPECT_EQ(filled.counts.outer, 1);
  EXPECT_EQ(filled.counts.unsplittable, 0);
  EXPECT_EQ(filled.counts.filled, filled.counts.loops - 1);
  EXPECT_EQ(fault_of(filled.surface), "");
}

// The boundary runs round both holes, and passes each copy of the vertex once.
TEST(HoleFillingTest, AVertexThatTwoHolesTouchBecomesOneAgain) {
  const Surface sphere = built(shapes::icosphere(3));
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(sphere.points.size()); ++v) {
    std::vector<std::int32_t> ring;
    for (const std::int32_t h : outgoing(sphere, v)) ring.push_back(sphere.target(h));
    if (ring.size() != 6) continue;
    TriangleMesh mesh;
    for (const auto& p : sphere.points) mesh.points.push_back(p.cast<double>());
    mesh.triangles = sphere.triangles;
    std::erase_if(mesh.triangles, [&](const auto& t) {
      return std::ranges::find(t, ring[0]) != t.end() || std::ranges::find(t, ring[3]) != t.end();
    });
    const FilledSurface filled = fill_holes(built(std::move(mesh)), 1000);
    EXPECT_EQ(filled.counts, counts(2, 2, 0)) << v;
    EXPECT_EQ(fault_of(filled.surface), "");
    EXPECT_EQ(euler_characteristic(filled.surface), 2);
    for (const auto& t : filled.surface.triangles)
      for (int i = 0; i < 3; ++i)
        EXPECT_NE(filled.surface.points[t[i]], filled.surface.points[t[(i + 1) % 3]]) << v;
  }
}

TEST(HoleFillingTest, ADiagonalThatIsAnEdgeAlreadyIsNotMadeTwice) {
  // The lower side of a square, with the diagonal 0 - 2; the upper side must get the other one.
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 2, 1}, {0, 3, 2}}};
  const Surface sheet = built(std::move(mesh));
  const BoundaryLoop loop{.vertices = {0, 1, 2, 3}, .joins = {}};
  const HolePatch patch = make_hole_patch(sheet, loop, {.refine = false});
  ASSERT_EQ(patch.triangles.size(), 2u);
  for (const auto& t : patch.triangles) {
    EXPECT_TRUE(std::find(t.begin(), t.end(), 1) != t.end());
    EXPECT_TRUE(std::find(t.begin(), t.end(), 3) != t.end());
  }
}

TEST(HoleFillingTest, SharedOutItIsTheSame) {
  const Surface open = punched(shapes::icosphere(4), [](const auto& p) {
    return std::abs(p.x()) > 0.97 || std::abs(p.y()) > 0.97;
  });
  const auto loops = boundary_loops(open);
  std::vector<HolePatch> patches(loops.size());
  for (std::size_t k = loops.size(); k-- > 0;) patches[k] = make_hole_patch(open, loops[k]);
  const FilledSurface shared = insert_patches(open, loops, patches, 1000);
  const FilledSurface whole = fill_holes(open, 1000);
  EXPECT_EQ(shared.surface.triangles, whole.surface.triangles);
  EXPECT_EQ(shared.surface.points, whole.surface.points);
  EXPECT_EQ(shared.counts, whole.counts);
}

TEST(HoleFillingTest, ALongNoisyRimIsFilled) {
  const int n = 2000;
  const double edge = 2 * 3.14159 / n;
  TriangleMesh mesh = shapes::cylinder(1, 6 * edge, n, 6);
  for (auto& p : mesh.points) p.z() += 0.1 * std::cos(3 * std::atan2(p.y(), p.x()));
  shapes::add_noise(mesh, 0.3 * edge, 3);
  const Surface ring = built(std::move(mesh));
  const FilledSurface filled = fill_holes(ring, n, {.max_new_vertices = 2000});
  EXPECT_EQ(filled.counts, counts(2, 1, 1));
  EXPECT_EQ(euler_characteristic(filled.surface), 1);
  EXPECT_EQ(fault_of(filled.surface), "");
}

TEST(HoleFillingTest, LargeHolesGetLargerFaces) {
  const Surface open =
      punched(shapes::icosphere(5), [](const auto& p) { return p.z() > std::cos(0.5); });
  const FilledSurface filled = fill_holes(open, 1000, {.max_new_vertices = 50});
  EXPECT_EQ(filled.counts.filled, 1);
  EXPECT_LT(filled.surface.vertex_count(), open.vertex_count() + 150);
  EXPECT_EQ(fault_of(filled.surface), "");
}

}  // namespace
}  // namespace semigeo::kernels
