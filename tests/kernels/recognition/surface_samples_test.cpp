#include "kernels/recognition/surface_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/shapes.hpp"

namespace semigeo::kernels {
namespace {

using Eigen::Vector3f;

SurfaceSamples samples_of(const TriangleMesh& mesh, std::int64_t count) {
  std::vector<Vector3f> points;
  std::vector<Vector3f> normals;
  for (const auto& p : mesh.points) {
    points.push_back(p.cast<float>());
    normals.push_back(p.cast<float>().stableNormalized());
  }
  return sample_surface(points, mesh.triangles, normals, count);
}

/// Shares of the samples in the eight octants.
std::array<double, 8> octants(const SurfaceSamples& samples, std::size_t count) {
  std::array<double, 8> shares = {};
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3f& p = samples.points[i];
    shares[(p.x() > 0) + 2 * (p.y() > 0) + 4 * (p.z() > 0)] += 1.0 / static_cast<double>(count);
  }
  return shares;
}

// One octant has been refined: nine tenths of the triangles have an eighth of the area.
TEST(SurfaceSamples, AreSpreadByAreaWhateverTheTriangles) {
  TriangleMesh mesh = shapes::icosphere(3);
  for (int round = 0; round < 3; ++round) {
    const auto triangles = mesh.triangles;
    for (std::size_t f = 0; f < triangles.size(); ++f) {
      const auto [a, b, c] = triangles[f];
      const Eigen::Vector3d middle = (mesh.points[a] + mesh.points[b] + mesh.points[c]) / 3;
      if (middle.minCoeff() < 0) continue;
      const auto m = static_cast<std::int32_t>(mesh.points.size());
      mesh.points.push_back(middle);
      mesh.triangles[f] = {a, b, m};
      mesh.triangles.push_back({b, c, m});
      mesh.triangles.push_back({c, a, m});
    }
  }
  const SurfaceSamples samples = samples_of(mesh, 4000);
  ASSERT_EQ(samples.points.size(), 4000U);
  // Every beginning is spread as well: that is what coarse looks rely on.
  for (const double share : octants(samples, 4000)) EXPECT_NEAR(share, 0.125, 0.01);
  for (const double share : octants(samples, 150)) EXPECT_NEAR(share, 0.125, 0.05);
}

TEST(SurfaceSamples, LieOnTheSurfaceWithItsNormals) {
  const SurfaceSamples samples = samples_of(shapes::icosphere(4), 1000);
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    EXPECT_NEAR(samples.points[i].norm(), 1, 0.005);
    EXPECT_NEAR(samples.normals[i].norm(), 1, 1e-5);
    EXPECT_GT(samples.normals[i].dot(samples.points[i].normalized()), 0.999);
  }
  EXPECT_NEAR(samples.spacing, std::sqrt(4 * M_PI / 1000), 0.01 * samples.spacing);
}

TEST(SurfaceSamples, AClosedSurfaceHasNoRim) {
  const TriangleMesh mesh = shapes::icosphere(2);
  SurfaceSamples samples = samples_of(mesh, 100);
  std::vector<Vector3f> points;
  for (const auto& p : mesh.points) points.push_back(p.cast<float>());
  mark_rim(points, mesh.triangles, samples);
  EXPECT_TRUE(samples.rim.empty());
}

TEST(SurfaceSamples, NoAreaNoSamples) {
  EXPECT_TRUE(samples_of({}, 10).points.empty());
  TriangleMesh line;
  line.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  line.triangles = {{0, 1, 2}};
  EXPECT_TRUE(samples_of(line, 10).points.empty());
  EXPECT_TRUE(samples_of(shapes::icosphere(1), 0).points.empty());
}

}  // namespace
}  // namespace semigeo::kernels
