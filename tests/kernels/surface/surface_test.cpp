#include "kernels/surface/surface.hpp"

#include <gtest/gtest.h>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <set>

#include "kernels/repair/surface_builder.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::kernels {
namespace {

TEST(SurfaceTest, NextAndPrevStayInTheFace) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(next(halfedge(5, i)), halfedge(5, (i + 1) % 3));
    EXPECT_EQ(prev(halfedge(5, i)), halfedge(5, (i + 2) % 3));
  }
}

// OpenMesh is the oracle: the same neighbours, boundaries and edges.
void expect_same_as_open_mesh(const TriangleMesh& mesh) {
  OpenMesh::TriMesh_ArrayKernelT<> oracle;
  for (const auto& p : mesh.points)
    oracle.add_vertex(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  for (const auto& t : mesh.triangles)
    oracle.add_face(oracle.vertex_handle(t[0]), oracle.vertex_handle(t[1]),
                    oracle.vertex_handle(t[2]));

  const Surface s = build_surface(TriangleMesh(mesh)).surface;
  ASSERT_EQ(s.vertex_count(), static_cast<std::int64_t>(oracle.n_vertices()));
  double length = 0;
  for (const auto e : oracle.edges()) length += oracle.calc_edge_length(e);
  EXPECT_NEAR(mean_edge_length(s), length / static_cast<double>(oracle.n_edges()), 1e-6);
  for (std::int32_t v = 0; v < s.vertex_count(); ++v) {
    const auto handle = oracle.vertex_handle(v);
    EXPECT_EQ(s.on_boundary(v), oracle.is_boundary(handle));
    std::set<int> expected, found;
    for (const auto w : oracle.vv_range(handle)) expected.insert(w.idx());
    for (std::int32_t h = s.outgoing[v]; h != kNone;) {
      found.insert(s.target(h));
      found.insert(s.origin(prev(h)));
      h = s.ccw(h);
      if (h == s.outgoing[v]) break;
    }
    EXPECT_EQ(found, expected);
  }
}

TEST(SurfaceTest, ConnectivityIsThatOfOpenMesh) {
  expect_same_as_open_mesh(shapes::icosphere(3));
  expect_same_as_open_mesh(shapes::plane(1, 7));
  expect_same_as_open_mesh(shapes::cylinder(1, 2, 9, 4));
  expect_same_as_open_mesh(shapes::torus(1, 0.4, 12, 9, 0.3));
}

TEST(SurfaceTest, PartsAreNumberedByFirstVertex) {
  TriangleMesh mesh = shapes::plane(1, 2);
  const auto n = static_cast<std::int32_t>(mesh.points.size());
  for (const auto& t : shapes::plane(1, 2).triangles)
    mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  for (const auto& p : shapes::plane(1, 2).points)
    mesh.points.push_back(p + Eigen::Vector3d(9, 0, 0));
  const Surface s = build_surface(std::move(mesh)).surface;
  EXPECT_EQ(s.part_count, 2);
  for (std::int32_t v = 0; v < s.vertex_count(); ++v) EXPECT_EQ(s.part[v], v < n ? 0 : 1);
}

}  // namespace
}  // namespace semigeo::kernels
