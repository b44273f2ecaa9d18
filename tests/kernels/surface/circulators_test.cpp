#include "kernels/surface/circulators.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "kernels/repair/surface_builder.hpp"
#include "kernels/surface/surface_editor.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::kernels {
namespace {

using Indices = std::vector<std::int32_t>;

Surface built(TriangleMesh mesh) {
  return build_surface(std::move(mesh)).surface;
}

Surface single_triangle() {
  return built({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
}

template <typename Range>
Indices all_of(const Range& range) {
  Indices result;
  for (const std::int32_t index : range) result.push_back(index);
  return result;
}

/// Every half-edge that leaves v, found without twins, in ascending order.
Indices leaving(const Connectivity& mesh, std::int32_t v) {
  Indices result;
  for (std::int32_t f = 0; f < mesh.face_count(); ++f)
    for (int i = 0; i < 3; ++i)
      if (mesh.triangles[f][i] == v) result.push_back(halfedge(f, i));
  return result;
}

void expect_whole_fans(const Connectivity& mesh) {
  for (std::int32_t v = 0; v < mesh.vertex_count(); ++v) {
    const Indices fan = all_of(outgoing(mesh, v));
    // Each next face begins at the edge where the one before ends.
    for (std::size_t k = 1; k < fan.size(); ++k)
      EXPECT_EQ(mesh.target(fan[k]), mesh.origin(prev(fan[k - 1])));
    Indices ring;
    for (const std::int32_t h : fan) ring.push_back(mesh.target(h));
    if (mesh.on_boundary(v)) ring.push_back(mesh.origin(prev(fan.back())));
    EXPECT_EQ(all_of(neighbours(mesh, v)), ring);
    Indices sorted = fan;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(sorted, leaving(mesh, v));
  }
}

TEST(CirculatorsTest, AFanIsVisitedOnceAndAnticlockwise) {
  expect_whole_fans(built(shapes::icosphere(2)));
  expect_whole_fans(built(shapes::plane(1, 4)));
  expect_whole_fans(single_triangle());
}

TEST(CirculatorsTest, AnOpenFanBeginsAtTheBoundary) {
  const Surface sheet = built(shapes::plane(1, 4));
  int open = 0;
  for (std::int32_t v = 0; v < sheet.vertex_count(); ++v) {
    if (!sheet.on_boundary(v)) continue;
    ++open;
    EXPECT_EQ(sheet.twin[*outgoing(sheet, v).begin()], kNone);
  }
  EXPECT_EQ(open, 16);
}

TEST(CirculatorsTest, ACornerOfASingleTriangleHasOneFaceAndTwoNeighbours) {
  const Surface s = single_triangle();
  EXPECT_EQ(all_of(outgoing(s, 1)), Indices{1});
  EXPECT_EQ(all_of(neighbours(s, 1)), (Indices{2, 0}));
  EXPECT_EQ(all_of(edges(s)), (Indices{0, 1, 2}));
}

TEST(CirculatorsTest, EveryEdgeIsVisitedOnceInAscendingOrder) {
  for (const Surface& s : {built(shapes::icosphere(2)), built(shapes::plane(1, 4))}) {
    const Indices all = all_of(edges(s));
    EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
    std::set<std::pair<std::int32_t, std::int32_t>> wanted;
    std::set<std::pair<std::int32_t, std::int32_t>> found;
    for (const auto& t : s.triangles)
      for (int i = 0; i < 3; ++i) wanted.insert(std::minmax({t[i], t[(i + 1) % 3]}));
    for (const std::int32_t h : all) {
      EXPECT_LT(s.twin[h], h);
      found.insert(std::minmax({s.origin(h), s.target(h)}));
    }
    EXPECT_EQ(found, wanted);
    EXPECT_EQ(all.size(), wanted.size());
  }
}

TEST(CirculatorsTest, RangesOfFacesShareTheEdgesAmongThemselves) {
  const Surface s = built(shapes::icosphere(2));
  Indices pieces;
  for (std::int32_t f = 0; f < s.face_count(); f += 32)
    for (const std::int32_t h : edges(s, f, f + 32)) pieces.push_back(h);
  EXPECT_EQ(pieces, all_of(edges(s)));
}

TEST(CirculatorsTest, AMeshWithoutFacesHasNoEdges) {
  EXPECT_TRUE(all_of(edges(Connectivity{})).empty());
}

TEST(CirculatorsTest, WhatWasRemovedIsPassedOver) {
  Surface s = built(shapes::plane(1, 2));
  SurfaceEditor(s).drop_part(0);
  EXPECT_TRUE(all_of(edges(s)).empty());
  EXPECT_TRUE(all_of(outgoing(s, 0)).empty());
  EXPECT_TRUE(all_of(neighbours(s, 0)).empty());
}

}  // namespace
}  // namespace semigeo::kernels
