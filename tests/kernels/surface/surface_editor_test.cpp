#include "kernels/surface/surface_editor.hpp"

#include <gtest/gtest.h>

#include <random>

#include "kernels/repair/surface_builder.hpp"
#include "kernels/surface/circulators.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/soundness.hpp"

namespace semigeo::kernels {
namespace {

using tests::euler_characteristic;
using tests::fault_of;
using Obstacle = SurfaceEditor::Obstacle;

Surface built(TriangleMesh mesh) {
  return build_surface(std::move(mesh)).surface;
}

TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

/// The half-edge between two vertices, in either direction.
std::int32_t edge_between(const Surface& s, std::int32_t a, std::int32_t b) {
  for (std::int32_t f = 0; f < s.face_count(); ++f)
    for (int i = 0; i < 3 && s.triangles[f][0] != kNone; ++i) {
      const std::int32_t h = halfedge(f, i);
      if (s.origin(h) == a && s.target(h) == b) return h;
    }
  return a > b ? edge_between(s, b, a) : kNone;
}

/// A tube of three vertices around, open at both ends: rings 0, 1, 2, ... of vertices 3 k + i.
TriangleMesh three_sided_tube(int rings) {
  TriangleMesh mesh;
  for (int k = 0; k < rings; ++k)
    for (int i = 0; i < 3; ++i)
      mesh.points.push_back({std::cos(i * 2.1), std::sin(i * 2.1), static_cast<double>(k)});
  for (int k = 0; k + 1 < rings; ++k)
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      mesh.triangles.push_back({3 * k + i, 3 * k + j, 3 * k + 3 + i});
      mesh.triangles.push_back({3 * k + j, 3 * k + 3 + j, 3 * k + 3 + i});
    }
  return mesh;
}

std::int32_t parts_of(Surface surface) {
  std::int32_t parts = 0;
  SurfaceEditor editor(surface);
  for (std::int32_t f = 0; f < surface.face_count(); ++f)
    if (editor.has_face(f)) {
      editor.drop_part(f);
      ++parts;
    }
  return parts;
}

TEST(SurfaceEditorTest, ACollapseTakesAVertexAndTwoFaces) {
  Surface s = built(shapes::icosphere(2));
  SurfaceEditor editor(s);
  const std::int32_t h = halfedge(17, 1);
  const std::int32_t kept = s.origin(h);
  const std::int32_t gone = s.target(h);
  ASSERT_EQ(editor.may_collapse(h).obstacle, Obstacle::kNothing);
  editor.collapse(h);
  EXPECT_EQ(fault_of(s), "");
  EXPECT_TRUE(editor.has_vertex(kept));
  EXPECT_FALSE(editor.has_vertex(gone));
  EXPECT_EQ(editor.vertex_count(), 161);
  EXPECT_EQ(editor.face_count(), 318);
  EXPECT_EQ(euler_characteristic(s), 2);
}

TEST(SurfaceEditorTest, ABoundaryEdgeCollapsesAlongTheBoundary) {
  Surface s = built(shapes::plane(1, 4));
  SurfaceEditor editor(s);
  std::int32_t h = 0;
  while (s.twin[h] != kNone || h % 4 == 3) ++h;
  ASSERT_EQ(editor.may_collapse(h).obstacle, Obstacle::kNothing);
  editor.collapse(h);
  EXPECT_EQ(fault_of(s), "");
  EXPECT_EQ(editor.face_count(), 31);
  EXPECT_EQ(euler_characteristic(s), 1);
}

TEST(SurfaceEditorTest, TheLastTetrahedronAndTheLastTriangleDoNotCollapse) {
  Surface solid = built(tetrahedron());
  EXPECT_EQ(SurfaceEditor(solid).may_collapse(0).obstacle, Obstacle::kPart);
  Surface single = built({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  EXPECT_EQ(SurfaceEditor(single).may_collapse(0).obstacle, Obstacle::kPart);
  // Three of the four faces: the fourth vertex may go.
  TriangleMesh cap = tetrahedron();
  cap.triangles.pop_back();
  Surface open = built(cap);
  SurfaceEditor editor(open);
  const std::int32_t h = editor.from_larger_fan(edge_between(open, 0, 1));
  ASSERT_EQ(editor.may_collapse(h).obstacle, Obstacle::kNothing);
  editor.collapse(h);
  EXPECT_EQ(fault_of(open), "");
  EXPECT_EQ(editor.face_count(), 1);
}

TEST(SurfaceEditorTest, ANeckOfThreeEdgesIsCutAndCovered) {
  Surface s = built(three_sided_tube(5));
  SurfaceEditor editor(s);
  const std::int32_t h = edge_between(s, 6, 7);
  const auto check = editor.may_collapse(h);
  ASSERT_EQ(check.obstacle, Obstacle::kCycle);
  ASSERT_EQ(check.third, 8);
  const auto covers = editor.cut_cycle(6, 7, 8);
  EXPECT_EQ(fault_of(s), "");
  EXPECT_EQ(editor.births().size(), 3);
  EXPECT_EQ(editor.face_count(), 24 + 2);
  EXPECT_EQ(euler_characteristic(s), 2);  // two cups instead of a tube
  EXPECT_EQ(parts_of(s), 2);
  // Now the edge collapses on both sides.
  for (const std::int32_t f : covers)
    EXPECT_EQ(editor.may_collapse(halfedge(f, 0)).obstacle, Obstacle::kNothing);
}

TEST(SurfaceEditorTest, ACutThroughAHandleOpensIt) {
  // A torus of 3 x 12 vertices: its short way round has three edges.
  Surface s = built(shapes::torus(1, 0.3, 12, 3));
  EXPECT_EQ(euler_characteristic(s), 0);
  SurfaceEditor editor(s);
  for (std::int32_t f = 0; f < 72; ++f) {
    const auto check = editor.may_collapse(halfedge(f, 0));
    if (check.obstacle != Obstacle::kCycle) continue;
    editor.cut_cycle(s.origin(halfedge(f, 0)), s.target(halfedge(f, 0)), check.third);
    break;
  }
  EXPECT_EQ(fault_of(s), "");
  EXPECT_EQ(euler_characteristic(s), 2);
  EXPECT_EQ(parts_of(s), 1);
}

TEST(SurfaceEditorTest, AHoleOfThreeEdgesIsCovered) {
  Surface s = built(three_sided_tube(3));
  SurfaceEditor editor(s);
  const auto covers = editor.cut_cycle(0, 1, 2);
  EXPECT_EQ((covers[0] == kNone) + (covers[1] == kNone), 1);
  EXPECT_EQ(fault_of(s), "");
  EXPECT_EQ(editor.births().size(), 0);
  EXPECT_EQ(euler_characteristic(s), 1);
}

TEST(SurfaceEditorTest, AStripIsCutAcross) {
  // Two squares side by side; the edge between them joins two boundary vertices.
  Surface s = built({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}},
                     {{0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {2, 5, 4}}});
  SurfaceEditor editor(s);
  const std::int32_t h = edge_between(s, 1, 4);
  ASSERT_EQ(editor.may_collapse(h).obstacle, Obstacle::kChord);
  editor.cut_chord(h);
  EXPECT_EQ(fault_of(s), "");
  EXPECT_EQ(parts_of(s), 2);
  EXPECT_EQ(editor.vertex_count(), 8);
  for (const auto& birth : editor.births()) EXPECT_EQ(birth.second, kNone);
}

TEST(SurfaceEditorTest, ASplitHalvesBothFaces) {
  for (const bool open : {false, true}) {
    Surface s = built(open ? shapes::plane(1, 3) : shapes::icosphere(1));
    const auto euler = euler_characteristic(s);
    SurfaceEditor editor(s);
    for (std::int32_t f = 0; f < 18; ++f)
      for (int i = 0; i < 3; ++i) {
        const std::int32_t h = halfedge(f, i);
        const std::int32_t a = s.origin(h);
        const std::int32_t b = s.target(h);
        const bool rim = s.twin[h] == kNone;
        const auto faces = editor.face_count();
        const std::int32_t v = editor.split(h);
        ASSERT_EQ(fault_of(s), "");
        EXPECT_EQ(editor.face_count(), faces + (rim ? 1 : 2));
        EXPECT_EQ(editor.births().back().first, a);
        EXPECT_EQ(editor.births().back().second, b);
        EXPECT_EQ(s.on_boundary(v), rim);
      }
    EXPECT_EQ(euler_characteristic(s), euler);
  }
}

TEST(SurfaceEditorTest, AFlipTurnsAnEdgeToTheOtherDiagonal) {
  for (const bool open : {false, true}) {
    Surface s = built(open ? shapes::plane(1, 3) : shapes::icosphere(1));
    SurfaceEditor editor(s);
    for (std::int32_t f = 0; f < 18; ++f)
      for (int i = 0; i < 3; ++i) {
        const std::int32_t h = halfedge(f, i);
        if (!editor.may_flip(h)) continue;
        const std::int32_t c = s.origin(prev(h));
        const std::int32_t d = s.origin(prev(s.twin[h]));
        const std::int32_t now = editor.flip(h);
        ASSERT_EQ(fault_of(s), "");
        EXPECT_EQ(std::minmax(s.origin(now), s.target(now)), std::minmax(c, d));
      }
    EXPECT_EQ(euler_characteristic(s), open ? 1 : 2);
  }
  Surface solid = built(tetrahedron());
  EXPECT_FALSE(SurfaceEditor(solid).may_flip(0));  // that edge is there already
}

TEST(SurfaceEditorTest, AFaceIsSplitIntoThree) {
  Surface s = built(shapes::plane(1, 3));
  SurfaceEditor editor(s);
  const Triangle corners = s.triangles[4];
  const std::int32_t v = editor.split_face(4);
  EXPECT_EQ(fault_of(s), "");
  EXPECT_EQ(editor.face_count(), 20);
  EXPECT_EQ(editor.vertex_count(), 17);
  EXPECT_EQ(v, 16);
  EXPECT_EQ(s.triangles[4], (Triangle{corners[0], corners[1], v}));
  EXPECT_EQ(s.triangles[18], (Triangle{corners[1], corners[2], v}));
  EXPECT_EQ(s.triangles[19], (Triangle{corners[2], corners[0], v}));
  const auto birth = editor.births().front();
  EXPECT_EQ((Triangle{birth.first, birth.second, birth.third}), corners);
}

/// A cover of the faces round v: a fan from its first neighbour; empty if that joins what is joined
/// already.
std::vector<Triangle> fan_cover(const Surface& s, std::int32_t v) {
  std::vector<std::int32_t> ring;
  for (const std::int32_t w : neighbours(s, v)) ring.push_back(w);
  std::vector<Triangle> cover;
  for (std::size_t k = 1; k + 1 < ring.size(); ++k) {
    const bool is_side = k + 2 == ring.size() && !s.on_boundary(v);
    if (!is_side && find_edge(s, ring[0], ring[k + 1]) != kNone) return {};
    cover.push_back({ring[0], ring[k], ring[k + 1]});
  }
  return cover;
}

TEST(SurfaceEditorTest, VerticesAreRemovedOneAfterTheOther) {
  for (const bool open : {false, true}) {
    Surface s = built(open ? shapes::plane(1, 4) : shapes::icosphere(1));
    const auto vertices = static_cast<std::int32_t>(s.vertex_count());
    SurfaceEditor editor(s);
    int removed = 0;
    for (std::int32_t v = 0; v < vertices; ++v) {
      const std::vector<std::int32_t> faces = [&] {
        std::vector<std::int32_t> result;
        for (const std::int32_t h : outgoing(s, v)) result.push_back(face_of(h));
        return result;
      }();
      const std::vector<Triangle> cover = fan_cover(s, v);
      if (cover.empty()) continue;
      editor.remove_vertex(v, cover);
      ++removed;
      ASSERT_EQ(fault_of(s), "") << "vertex " << v;
      EXPECT_FALSE(editor.has_vertex(v));
      EXPECT_EQ(editor.vertex_count(), vertices - removed);
      for (std::size_t k = 0; k < faces.size(); ++k) {
        ASSERT_EQ(editor.has_face(faces[k]), k < cover.size());
        if (k < cover.size()) EXPECT_EQ(s.triangles[faces[k]], cover[k]);
      }
      EXPECT_EQ(euler_characteristic(s), open ? 1 : 2);
    }
    EXPECT_GE(removed, vertices / 3);
  }
}

TEST(SurfaceEditorTest, APartIsDroppedWhole) {
  TriangleMesh mesh = tetrahedron();
  for (const auto& p : shapes::icosphere(1).points) mesh.points.push_back(p);
  for (auto t : shapes::icosphere(1).triangles)
    mesh.triangles.push_back({t[0] + 4, t[1] + 4, t[2] + 4});
  Surface s = built(mesh);
  SurfaceEditor editor(s);
  const auto dropped = editor.drop_part(2);
  EXPECT_EQ(dropped.vertices, 4);
  EXPECT_EQ(dropped.faces, 4);
  EXPECT_EQ(editor.face_count(), 80);
  EXPECT_EQ(editor.vertex_count(), 42);
  EXPECT_EQ(fault_of(s), "");
}

// Whatever comes next, in any order, the surface stays one.
TEST(SurfaceEditorTest, AnySequenceOfEditsLeavesASurface) {
  TriangleMesh meshes[] = {shapes::icosphere(2), shapes::torus(1, 0.4, 9, 5), shapes::plane(1, 6),
                           shapes::hemisphere(2), three_sided_tube(8)};
  std::mt19937 random(5);
  for (const TriangleMesh& mesh : meshes)
    for (int run = 0; run < 6; ++run) {
      Surface s = built(mesh);
      SurfaceEditor editor(s);
      for (int k = 0; k < 400 && editor.face_count() > 0; ++k) {
        const auto f = static_cast<std::int32_t>(random() % s.triangles.size());
        if (!editor.has_face(f)) continue;
        std::int32_t h = halfedge(f, static_cast<int>(random() % 3));
        if (random() % 8 < static_cast<unsigned>(run)) {
          if (random() % 4 == 0)
            editor.split_face(f);
          else
            editor.split(h);
        } else if (random() % 3 == 0) {
          if (editor.may_flip(h)) editor.flip(h);
        } else {
          h = editor.from_larger_fan(h);
          const auto check = editor.may_collapse(h);
          switch (check.obstacle) {
            case Obstacle::kNothing:
              editor.collapse(h);
              break;
            case Obstacle::kCycle:
              editor.cut_cycle(s.origin(h), s.target(h), check.third);
              break;
            case Obstacle::kChord:
              editor.cut_chord(h);
              break;
            case Obstacle::kPart:
              editor.drop_part(f);
              break;
          }
        }
        ASSERT_EQ(fault_of(s), "") << "run " << run << ", edit " << k;
      }
      EXPECT_EQ(editor.face_count(),
                std::ranges::count_if(s.triangles, [](const auto& t) { return t[0] != kNone; }));
      EXPECT_EQ(editor.vertex_count(),
                std::ranges::count_if(s.outgoing, [](auto h) { return h != kNone; }));
    }
}

}  // namespace
}  // namespace semigeo::kernels
