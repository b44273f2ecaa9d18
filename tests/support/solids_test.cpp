#include "tests/support/solids.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "kernels/repair/surface_builder.hpp"
#include "tests/support/manifold.hpp"
#include "tests/support/triangle_intersections.hpp"

namespace semigeo::shapes {
namespace {

using Eigen::Vector3d;
using kernels::TriangleMesh;

double volume(const TriangleMesh& mesh) {
  double six = 0;
  for (const auto& t : mesh.triangles)
    six += mesh.points[t[0]].dot(mesh.points[t[1]].cross(mesh.points[t[2]]));
  return six / 6;
}

TEST(SolidsTest, IsosurfaceOfABallIsASphere) {
  const TriangleMesh mesh = isosurface(ball({0.1, 0.2, 0.3}, 1),
                                       {Vector3d::Constant(-1.2), Vector3d::Constant(1.5)}, 0.15);
  EXPECT_EQ(tests::why_not_manifold(mesh), "");
  EXPECT_EQ(mesh.triangles.size(), 2 * mesh.points.size() - 4);
  EXPECT_NEAR(volume(mesh), 4 * std::numbers::pi / 3, 0.03);
  for (const auto& p : mesh.points) EXPECT_NEAR((p - Vector3d(0.1, 0.2, 0.3)).norm(), 1, 1e-9);
}

// In one piece, without handles but for the chair's, and with no sliver.
TEST(SolidsTest, ObjectsAreClosedSimpleAndEven) {
  struct {
    const char* name;
    TriangleMesh mesh;
    int handles;
  } objects[] = {{"dumbbell", dumbbell(), 0}, {"phone", phone(), 0}, {"chair", chair(), 1}};
  for (const auto& [name, mesh, handles] : objects) {
    EXPECT_EQ(tests::why_not_manifold(mesh), "") << name;
    EXPECT_EQ(tests::count_intersections(mesh), 0) << name;
    EXPECT_GT(mesh.points.size(), 1000u) << name;
    EXPECT_LT(mesh.points.size(), 2000u) << name;
    const auto vertices = static_cast<std::int64_t>(mesh.points.size());
    const auto faces = static_cast<std::int64_t>(mesh.triangles.size());
    EXPECT_EQ(vertices - faces / 2, 2 - 2 * handles) << name;
    const kernels::Surface surface = kernels::build_surface(TriangleMesh(mesh)).surface;
    EXPECT_EQ(surface.part_count, 1) << name;
    const double mean = kernels::mean_edge_length(surface);
    double shortest = mean;
    for (const auto& t : mesh.triangles)
      for (int i = 0; i < 3; ++i)
        shortest = std::min(shortest, (mesh.points[t[i]] - mesh.points[t[(i + 1) % 3]]).norm());
    EXPECT_GT(shortest, 0.3 * mean) << name;
    EXPECT_GT(volume(mesh), 0) << name;
  }
}

}  // namespace
}  // namespace semigeo::shapes
