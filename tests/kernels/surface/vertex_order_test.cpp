#include "kernels/surface/vertex_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "kernels/repair/surface_builder.hpp"
#include "kernels/surface/surface_editor.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/soundness.hpp"

namespace semigeo::kernels {
namespace {

TriangleMesh two_spheres() {
  TriangleMesh mesh = shapes::icosphere(3);
  const TriangleMesh other = shapes::icosphere(2);
  const auto n = static_cast<std::int32_t>(mesh.points.size());
  for (const auto& p : other.points) mesh.points.push_back(p + Eigen::Vector3d(0.5, 0, 0));
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  return mesh;
}

TEST(VertexOrderTest, IsAPermutationThatKeepsPartsTogether) {
  const Surface s = build_surface(two_spheres()).surface;
  const auto order = locality_order(s);
  auto sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 0; i < sorted.size(); ++i) EXPECT_EQ(sorted[i], static_cast<int>(i));
  const Surface r = reordered(s, order);
  EXPECT_TRUE(std::is_sorted(r.part.begin(), r.part.end()));
  EXPECT_TRUE(std::is_sorted(r.triangles.begin(), r.triangles.end(),
                             [&](auto& a, auto& b) { return r.part[a[0]] < r.part[b[0]]; }));
}

TEST(VertexOrderTest, ConnectivityFollows) {
  const Surface s = build_surface(two_spheres()).surface;
  const auto order = locality_order(s);
  const Surface r = reordered(s, order);
  const Connectivity fresh = connect(r.triangles, r.vertex_count());
  std::vector<std::int32_t> part;
  EXPECT_EQ(number_parts(fresh, part), r.part_count);
  EXPECT_EQ(r.twin, fresh.twin);
  EXPECT_EQ(r.part, part);
  for (std::int32_t v = 0; v < r.vertex_count(); ++v) {
    EXPECT_EQ(r.origin(r.outgoing[v]), v);
    EXPECT_EQ(r.points[v], s.points[order[v]]);
  }
}

TEST(VertexOrderTest, GapsAreClosedAndTheOrderStays) {
  Surface s = build_surface(two_spheres()).surface;
  SurfaceEditor(s).drop_part(0);
  std::vector<std::int32_t> source;
  const Connectivity c = compacted(s, source);
  EXPECT_EQ(tests::fault_of(c), "");
  EXPECT_TRUE(std::is_sorted(source.begin(), source.end()));
  std::size_t next_face = 0;
  for (const Triangle& t : s.triangles) {
    if (t[0] == kNone) continue;
    ASSERT_LT(next_face, c.triangles.size());
    for (int i = 0; i < 3; ++i) EXPECT_EQ(source[c.triangles[next_face][i]], t[i]);
    ++next_face;
  }
  EXPECT_EQ(next_face, c.triangles.size());
  EXPECT_EQ(c.vertex_count(), 162);
}

TEST(VertexOrderTest, NeighboursComeCloser) {
  const Surface s = build_surface(shapes::icosphere(6)).surface;
  const Surface r = reordered(s, locality_order(s));
  const auto spread = [](const Surface& surface) {
    double sum = 0;
    for (const auto& t : surface.triangles) sum += std::abs(t[0] - t[1]);
    return sum / static_cast<double>(surface.triangles.size());
  };
  EXPECT_LT(spread(r), spread(s) / 4);
}

}  // namespace
}  // namespace semigeo::kernels
