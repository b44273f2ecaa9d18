#include "bench/recognition/touching.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/support/mesh_changes.hpp"
#include "kernels/repair/surface_builder.hpp"
#include "kernels/surface/nearest_surface.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::recognition {
namespace {

using kernels::TriangleMesh;

/// Solid angle of a closed mesh at a point over 4 pi: 1 inside, 0 outside.
double winding_number(const TriangleMesh& mesh, const Eigen::Vector3d& p) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.points[t[0]] - p, b = mesh.points[t[1]] - p,
                          c = mesh.points[t[2]] - p;
    const double na = a.norm(), nb = b.norm(), nc = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)),
                          na * nb * nc + a.dot(b) * nc + b.dot(c) * na + c.dot(a) * nb);
  }
  return sum / (4 * M_PI);
}

int vertices_inside(const TriangleMesh& points, const TriangleMesh& mesh) {
  return static_cast<int>(std::ranges::count_if(
      points.points, [&](const Eigen::Vector3d& p) { return winding_number(mesh, p) > 0.5; }));
}

double distance_between(const TriangleMesh& points, const TriangleMesh& mesh) {
  const kernels::BuiltSurface built = kernels::build_surface(TriangleMesh(mesh));
  const kernels::NearestSurface nearest(built.surface);
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& p : points.points)
    least = std::min(least, nearest.nearest(p - built.origin).distance);
  return least;
}

TriangleMesh moved(TriangleMesh mesh, const Eigen::Vector3d& shift) {
  for (Eigen::Vector3d& p : mesh.points) p += shift;
  return mesh;
}

TEST(WayToContact, OfTwoCubesIsTheGapBetweenTheirFaces) {
  const TriangleMesh still = shapes::cube(2, 4);
  const TriangleMesh above = moved(still, {0.1, 0.2, 5});
  EXPECT_NEAR(way_to_contact(above, still, {0, 0, 1}), 3, 1e-12);
  // Seen along another axis the one passes the other by.
  EXPECT_EQ(way_to_contact(above, still, {1, 0, 0}), std::numeric_limits<double>::infinity());
  // From inside out.
  EXPECT_NEAR(way_to_contact(moved(still, {0.1, 0.2, 0.5}), still, {0, 0, 1}), -1.5, 1e-12);
}

TEST(WayToContact, OfSpheresConvergesToTheTruth) {
  // Two unit spheres, centres 0.6 apart across the direction and 4 along it: they meet when they
  // are sqrt(4 - 0.36) apart along it.
  double last = 1;
  for (int level = 2; level <= 4; ++level) {
    const TriangleMesh sphere = shapes::icosphere(level);
    const Eigen::Vector3d direction = Eigen::Vector3d(1, 2, -2) / 3;
    const Eigen::Vector3d across = Eigen::Vector3d(2, 1, 2) / 3;
    const double way =
        way_to_contact(moved(sphere, 4 * direction + 0.6 * across), sphere, direction);
    const double error = std::abs(way - (4 - std::sqrt(4 - 0.36)));
    EXPECT_LT(error, last / 2);
    last = error;
  }
  EXPECT_LT(last, 0.005);
}

TEST(TouchingShift, MakesObjectsTouchWithoutAVertexInsideTheOther) {
  const TriangleMesh torus = shapes::torus(1, 0.4, 32, 16);
  const TriangleMesh cube = moved(shapes::cube(1.2, 6), {5, 5, 5});
  const TriangleMesh sphere = shapes::icosphere(3, 0.7);
  bench::Random numbers = bench::random(1, 0, "touching");
  for (const TriangleMesh* still : {&torus, &cube, &sphere})
    for (const TriangleMesh* moving : {&torus, &cube, &sphere})
      for (int i = 0; i < 3; ++i) {
        const TriangleMesh placed = moved(*moving, touching_shift(*moving, *still, numbers));
        EXPECT_EQ(vertices_inside(placed, *still), 0);
        EXPECT_EQ(vertices_inside(*still, placed), 0);
        EXPECT_LT(std::min(distance_between(placed, *still), distance_between(*still, placed)),
                  1e-5);
      }
}

}  // namespace
}  // namespace semigeo::recognition
