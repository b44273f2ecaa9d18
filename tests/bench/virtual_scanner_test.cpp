#include "bench/recognition/virtual_scanner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bench/support/mesh_changes.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::recognition {
namespace {

using Eigen::Vector3d;
using kernels::TriangleMesh;

TriangleMesh sphere_at(const Vector3d& centre, double radius, int level = 5) {
  TriangleMesh mesh = shapes::icosphere(level);
  for (Vector3d& p : mesh.points) p = centre + radius * p;
  return mesh;
}

/// Returns the depth at which a ray meets a sphere, or 0.
double depth_of_sphere(const Vector3d& ray, const Vector3d& centre, double radius) {
  const double a = ray.squaredNorm(), b = ray.dot(centre);
  const double root = b * b - a * (centre.squaredNorm() - radius * radius);
  return root < 0 ? 0 : (b - std::sqrt(root)) / a;
}

TEST(Camera, HasAllPointsJustWithinItsImage) {
  const TriangleMesh mesh = sphere_at({0.3, -0.2, -5}, 1);
  const Camera camera = camera_for(mesh.points, 120);
  EXPECT_EQ(std::max(camera.columns, camera.rows), 120);
  const DepthImage image = render(std::span(&mesh, 1), camera);
  const auto met_in_row = [&](std::int64_t row) {
    return std::count_if(image.depth.begin() + row * camera.columns,
                         image.depth.begin() + (row + 1) * camera.columns,
                         [](double depth) { return depth > 0; });
  };
  EXPECT_GT(met_in_row(1), 0);
  EXPECT_GT(met_in_row(camera.rows - 2), 0);
}

TEST(Render, SeesASphereAtItsDepth) {
  const Vector3d centre(0.3, -0.2, -5);
  const TriangleMesh mesh = sphere_at(centre, 1);
  const Camera camera = camera_for(mesh.points, 100);
  const DepthImage image = render(std::span(&mesh, 1), camera);
  int compared = 0;
  for (std::int64_t row = 0; row < camera.rows; ++row)
    for (std::int64_t column = 0; column < camera.columns; ++column) {
      const double depth = image.depth[static_cast<std::size_t>(row * camera.columns + column)];
      const Vector3d ray = camera.ray(row, column);
      // At the rim the polyhedron and the sphere differ.
      if (depth_of_sphere(ray, centre, 0.95) == 0) continue;
      EXPECT_NEAR(depth, depth_of_sphere(ray, centre, 1), 3e-3);
      ++compared;
    }
  EXPECT_GT(compared, 5000);
}

TEST(AreasOfObjects, TellHowMuchOfASphereIsHiddenByAPlate) {
  // The plate hides the half of the sphere with x < 0. From a distance d one sees the cap of area
  // 2 pi (1 - 1 / d) of a unit sphere.
  const double distance = 6;
  const TriangleMesh sphere = sphere_at({0, 0, -distance}, 1);
  TriangleMesh plate;
  plate.points = {{-2, -2, -2}, {0, -2, -2}, {0, 2, -2}, {-2, 2, -2}};
  plate.triangles = {{0, 1, 2}, {0, 2, 3}};
  const Camera camera = camera_for(sphere.points, 300);
  const double cap = 2 * std::numbers::pi * (1 - 1 / distance);
  const auto seen = [&](const std::vector<TriangleMesh>& objects) {
    return areas_of_objects(triangulated(render(objects, camera), camera), objects.size()).front();
  };
  // Triangles that are seen at more than about 75 degrees are left out: a quarter of the cap.
  EXPECT_LT(seen({sphere}), cap);
  EXPECT_GT(seen({sphere}), 0.75 * cap);
  EXPECT_NEAR(seen({sphere, plate}) / seen({sphere}), 0.5, 0.03);
}

TEST(Triangulated, FacesTheCamera) {
  const TriangleMesh sphere = sphere_at({0, 0.5, -4}, 1);
  const Camera camera = camera_for(sphere.points, 80);
  const VirtualScan scan = triangulated(render(std::span(&sphere, 1), camera), camera);
  ASSERT_GT(scan.mesh.triangles.size(), 5000);
  for (const auto& t : scan.mesh.triangles) {
    const Vector3d& a = scan.mesh.points[t[0]];
    EXPECT_LT((scan.mesh.points[t[1]] - a).cross(scan.mesh.points[t[2]] - a).dot(a), 0);
  }
}

TEST(Disturb, AddsNoiseAlongTheRayAndRoundsDepths) {
  const Camera camera{.focal = 100, .left = -100, .bottom = -100, .columns = 200, .rows = 200};
  const DepthImage flat{.depth = std::vector<double>(40'000, 2.0),
                        .object = std::vector<std::int32_t>(40'000, 0)};
  DepthImage noisy = flat;
  bench::Random random = bench::random(1, 0, "noise");
  disturb(noisy, camera, {.noise = 0.25, .quantum = 0, .mixed = 0}, random);
  double squares = 0;
  for (const double depth : noisy.depth) squares += (depth - 2) * (depth - 2);
  EXPECT_NEAR(std::sqrt(squares / 40'000), 0.25 * 2 / 100, 2e-4);
  DepthImage rounded = noisy;
  disturb(rounded, camera, {.noise = 0, .quantum = 0.05, .mixed = 0}, random);
  for (std::size_t i = 0; i < rounded.depth.size(); ++i)
    EXPECT_NEAR(rounded.depth[i], noisy.depth[i], 0.5 * 0.05 * 2 / 100 * 1.01);
}

TEST(Disturb, MixesPixelsBesideDepthJumpsOnly) {
  const Camera camera{.focal = 100, .left = -50, .bottom = -50, .columns = 100, .rows = 100};
  DepthImage image{.depth = std::vector<double>(10'000, 3.0),
                   .object = std::vector<std::int32_t>(10'000, 1)};
  for (std::size_t pixel = 0; pixel < image.depth.size(); ++pixel)
    if (pixel % 100 < 50) image.depth[pixel] = 2, image.object[pixel] = 0;
  bench::Random random = bench::random(1, 0, "mixed");
  disturb(image, camera, {.noise = 0, .quantum = 0, .mixed = 0.5}, random);
  int mixed = 0;
  for (std::size_t pixel = 0; pixel < image.depth.size(); ++pixel) {
    if (image.object[pixel] >= 0) continue;
    ++mixed;
    EXPECT_EQ(pixel % 100, 49);
    EXPECT_GT(image.depth[pixel], 2);
    EXPECT_LT(image.depth[pixel], 3);
  }
  EXPECT_NEAR(mixed, 50, 20);
}

}  // namespace
}  // namespace semigeo::recognition
