#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "kernels/repair/surface_builder.hpp"
#include "kernels/surface/circulators.hpp"
#include "kernels/surface/surface_editor.hpp"

namespace semigeo::kernels {
namespace {

using Obstacle = SurfaceEditor::Obstacle;

/// Twice as many steps as faces are milliseconds; as many as the square of it, longer than a test
/// may take.
constexpr std::int32_t kSpokes = 400'000;

/// Part of a disc round vertex 0, on whose rim that lies: rings of `spokes` vertices.
Surface open_fan(std::int32_t spokes, int rings) {
  TriangleMesh mesh;
  mesh.points.emplace_back(0, 0, 0);
  for (int ring = 1; ring <= rings; ++ring)
    for (std::int32_t k = 0; k < spokes; ++k) {
      const double angle = 1.5 * std::numbers::pi * k / spokes;
      mesh.points.emplace_back(ring * std::cos(angle), ring * std::sin(angle), 0);
    }
  for (std::int32_t k = 1; k < spokes; ++k) mesh.triangles.push_back({0, k, k + 1});
  for (int ring = 1; ring < rings; ++ring)
    for (std::int32_t k = 1; k < spokes; ++k) {
      const std::int32_t a = (ring - 1) * spokes + k;
      const std::int32_t b = ring * spokes + k;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  return build_surface(std::move(mesh)).surface;
}

std::int64_t boundary_edges_at(const Surface& s, std::int32_t v) {
  std::int64_t edges = 0;
  for (const std::int32_t h : outgoing(s, v))
    edges += (s.twin[h] == kNone) + (s.twin[prev(h)] == kNone);
  return edges;
}

/// The half-edges with which the faces of the first ring leave vertex 0.
std::vector<std::int32_t> spokes_of(const Surface& s, std::int32_t spokes) {
  std::vector<std::int32_t> result;
  for (std::int32_t f = 0; f + 1 < spokes; ++f)
    for (int i = 0; i < 3; ++i)
      if (s.triangles[f][i] == 0) result.push_back(halfedge(f, i));
  return result;
}

// What is cut off is small, what it is cut from is not.
TEST(RemeshingHostileTest, CuttingSpokesOffAHubCostsNoMoreThanTheSpokes) {
  for (const bool backwards : {false, true}) {
    Surface s = open_fan(kSpokes, 1);
    SurfaceEditor editor(s);
    const std::vector<std::int32_t> spokes = spokes_of(s, kSpokes);
    for (std::int32_t k = 1; k + 1 < kSpokes; ++k) {
      const std::int32_t h = spokes[backwards ? kSpokes - 1 - k : k];
      ASSERT_NE(s.twin[h], kNone);
      editor.cut_chord(h);
    }
    EXPECT_EQ(editor.vertex_count(), 3 * (kSpokes - 1));
    for (std::int32_t v = 0; v < 3 * (kSpokes - 1); ++v) ASSERT_EQ(boundary_edges_at(s, v), 2);
  }
}

TEST(RemeshingHostileTest, CollapsingSpokesOfAHubOnTheRimCostsNoMoreThanTheSpokes) {
  for (const bool backwards : {false, true}) {
    Surface s = open_fan(kSpokes, 2);
    SurfaceEditor editor(s);
    for (std::int32_t k = 1; k + 1 < kSpokes; ++k) {
      const std::int32_t inner = backwards ? kSpokes - k : k + 1;
      std::int32_t h = s.outgoing[inner];
      while (s.target(h) != 0) h = s.ccw(h);
      h = s.twin[h];
      ASSERT_EQ(editor.may_collapse(h).obstacle, Obstacle::kNothing);
      editor.collapse(h);
    }
    EXPECT_EQ(boundary_edges_at(s, 0), 2);
    EXPECT_EQ(editor.vertex_count(), kSpokes + 3);
    EXPECT_EQ(editor.face_count(), 3 * (kSpokes - 1) - 2 * (kSpokes - 2));
  }
}

TEST(RemeshingHostileTest, AHubOnTheRimTakesInItsNeighboursThereNotTheyIt) {
  for (const bool backwards : {false, true}) {
    Surface s = open_fan(kSpokes, 1);
    SurfaceEditor editor(s);
    for (std::int32_t k = 2; k < kSpokes; ++k) {
      // The boundary edge that comes to the hub, or the one that leaves it.
      const std::int32_t edge = s.outgoing[backwards ? kSpokes + 2 - k : 0];
      ASSERT_EQ(s.twin[edge], kNone);
      ASSERT_EQ(editor.may_collapse(edge).obstacle, Obstacle::kNothing);
      ASSERT_EQ(editor.survivor(edge), 0);
      editor.collapse(edge);
    }
    EXPECT_EQ(editor.face_count(), 1);
    EXPECT_TRUE(editor.has_vertex(0));
  }
}

}  // namespace
}  // namespace semigeo::kernels
