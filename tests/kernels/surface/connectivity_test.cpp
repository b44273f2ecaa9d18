#include "kernels/surface/connectivity.hpp"

#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "kernels/repair/surface_builder.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/soundness.hpp"

namespace semigeo::kernels {
namespace {

TEST(ConnectivityTest, NextAndPrevStayInTheFace) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(next(halfedge(5, i)), halfedge(5, (i + 1) % 3));
    EXPECT_EQ(prev(halfedge(5, i)), halfedge(5, (i + 2) % 3));
  }
}

TEST(ConnectivityTest, TrianglesAreConnected) {
  for (const TriangleMesh& mesh : {shapes::icosphere(2), shapes::plane(1, 5)}) {
    const Connectivity s = connect(mesh.triangles, std::ssize(mesh.points));
    EXPECT_EQ(tests::fault_of(s), "");
    EXPECT_EQ(s.triangles, mesh.triangles);
    EXPECT_EQ(s.vertex_count(), std::ssize(mesh.points));
  }
}

TEST(ConnectivityTest, AnEdgeIsFoundFromBothEnds) {
  for (const TriangleMesh& mesh : {shapes::icosphere(1), shapes::plane(1, 3)}) {
    const Connectivity s = connect(mesh.triangles, std::ssize(mesh.points));
    std::set<std::pair<std::int32_t, std::int32_t>> joined;
    for (const Triangle& t : mesh.triangles)
      for (int i = 0; i < 3; ++i) {
        joined.emplace(t[i], t[(i + 1) % 3]);
        joined.emplace(t[(i + 1) % 3], t[i]);
      }
    for (std::int32_t a = 0; a < s.vertex_count(); ++a)
      for (std::int32_t b = 0; b < s.vertex_count(); ++b) {
        if (a == b) continue;
        const std::int32_t h = find_edge(s, a, b);
        ASSERT_EQ(h != kNone, joined.contains({a, b})) << a << " - " << b;
        if (h == kNone) continue;
        EXPECT_EQ(std::minmax(s.origin(h), s.target(h)), std::minmax(a, b));
      }
  }
}

TEST(ConnectivityTest, PartsAreNumberedByFirstVertex) {
  TriangleMesh mesh = shapes::plane(1, 2);
  const auto n = static_cast<std::int32_t>(mesh.points.size());
  for (const auto& t : shapes::plane(1, 2).triangles)
    mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  std::vector<std::int32_t> part;
  EXPECT_EQ(number_parts(connect(mesh.triangles, 2 * n), part), 2);
  for (std::int32_t v = 0; v < 2 * n; ++v) EXPECT_EQ(part[v], v < n ? 0 : 1);
}

}  // namespace
}  // namespace semigeo::kernels
