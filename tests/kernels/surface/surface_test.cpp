#include "kernels/surface/surface.hpp"

#include <gtest/gtest.h>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <set>

#include "kernels/repair/surface_builder.hpp"
#include "kernels/surface/circulators.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::kernels {
namespace {

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
    for (const std::int32_t w : neighbours(s, v)) found.insert(w);
    EXPECT_EQ(found, expected);
  }
}

TEST(SurfaceTest, ConnectivityIsThatOfOpenMesh) {
  expect_same_as_open_mesh(shapes::icosphere(3));
  expect_same_as_open_mesh(shapes::plane(1, 7));
  expect_same_as_open_mesh(shapes::cylinder(1, 2, 9, 4));
  expect_same_as_open_mesh(shapes::torus(1, 0.4, 12, 9, 0.3));
}

}  // namespace
}  // namespace semigeo::kernels
