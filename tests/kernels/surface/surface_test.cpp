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

TEST(SurfaceTest, OutliersDoNotCountAsEdges) {
  const TriangleMesh sphere = shapes::icosphere(5);
  const EdgeLengths plain = edge_lengths(build_surface(TriangleMesh(sphere)).surface);
  EXPECT_EQ(plain.limit, std::numeric_limits<double>::infinity());
  // One vertex far out; pixels without depth, one in a hundred; a few faces across everything.
  TriangleMesh far = sphere;
  far.points[77] *= 1e5;
  TriangleMesh pixels = sphere;
  for (std::size_t v = 50; v < pixels.points.size(); v += 100) pixels.points[v].setZero();
  TriangleMesh plate = sphere;
  const auto n = static_cast<std::int32_t>(plate.points.size());
  for (const auto& p : {Eigen::Vector3d(-50, -50, -2), Eigen::Vector3d(50, -50, -2),
                        Eigen::Vector3d(50, 50, -2), Eigen::Vector3d(-50, 50, -2)})
    plate.points.push_back(p);
  plate.triangles.push_back({n, n + 1, n + 2});
  plate.triangles.push_back({n, n + 2, n + 3});
  for (const TriangleMesh& mesh : {far, pixels, plate}) {
    const EdgeLengths lengths = edge_lengths(build_surface(TriangleMesh(mesh)).surface);
    EXPECT_NEAR(lengths.mean / plain.mean, 1, 1e-3);
    EXPECT_LT(lengths.limit, 21 * plain.mean);
  }
}

// Where long edges are more than a few, they are no outliers: every cell of a tall prism has some.
TEST(SurfaceTest, LongEdgesOfATallPrismAreItsOwn) {
  TriangleMesh prism = shapes::cylinder(1, 2, 60, 2);
  for (auto& p : prism.points) p.z() *= 100;
  const EdgeLengths lengths = edge_lengths(build_surface(std::move(prism)).surface);
  EXPECT_EQ(lengths.limit, std::numeric_limits<double>::infinity());
  EXPECT_GT(lengths.mean, 10);
}

TEST(SurfaceTest, ConnectivityIsThatOfOpenMesh) {
  expect_same_as_open_mesh(shapes::icosphere(3));
  expect_same_as_open_mesh(shapes::plane(1, 7));
  expect_same_as_open_mesh(shapes::cylinder(1, 2, 9, 4));
  expect_same_as_open_mesh(shapes::torus(1, 0.4, 12, 9, 0.3));
}

}  // namespace
}  // namespace semigeo::kernels
