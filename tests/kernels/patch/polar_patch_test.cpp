#include "kernels/patch/polar_patch.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "kernels/surface/circulators.hpp"
#include "tests/support/prepared_surface.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::kernels {
namespace {

using Eigen::Vector3f;

TEST(PolarWeightsTest, SumToOneAndSmoothAsTheGaussianOfSemigeodesicPatches) {
  const auto& w = polar_weights();
  double sum = w[0];
  double variance = 0;
  for (int k = 1; k <= kReach; ++k) {
    sum += kRays * w[k];
    variance += kRays * w[k] * k * k / 2;
    EXPECT_LT(w[k], w[k - 1]);
  }
  EXPECT_NEAR(sum, 1, 1e-6);
  EXPECT_NEAR(variance, gaussian_filters().variance, 1e-6);
}

// On a plane the patch is the polar grid from its first edge (4.1.3).
TEST(PolarPatchTest, PlaneGivesThePolarGrid) {
  TriangleMesh mesh = shapes::plane(20, 20);
  shapes::add_noise(mesh, 0.15, 3);
  for (auto& p : mesh.points) p.z() = 0;
  const PreparedSurface s(std::move(mesh));
  const GeodesicMesh m = s.mesh();
  const std::int32_t v = s.nearest({0, 0, 0});
  for (const std::int32_t first : outgoing(s.surface, v)) {
    PolarPatch patch;
    trace_polar_patch(s.sampled(), v, first, 0.8f, patch);
    ASSERT_TRUE(patch.whole());
    EXPECT_NEAR(patch.completeness(), 1, 1e-6);
    const Vector3f u = (m.point(m.origin(next(first))) - m.point(v)).normalized();
    for (int j = 0; j < kRays; ++j) {
      const double turn = 2 * std::numbers::pi * j / kRays;
      const Vector3f along = Eigen::AngleAxisf(static_cast<float>(turn), Vector3f::UnitZ()) * u;
      for (int k = 1; k <= kReach; ++k)
        EXPECT_LT((patch.sample[j][k - 1].head<3>() - 0.8f * k * along).norm(), 1e-3f);
    }
  }
}

/// A whole patch on the graph z = height(u, v).
template <typename Height>
PolarPatch graph_patch(const Height& height, float step) {
  PolarPatch patch;
  patch.reach.fill(kReach);
  for (int j = 0; j < kRays; ++j)
    for (int k = 1; k <= kReach; ++k) {
      const double turn = 2 * std::numbers::pi * j / kRays;
      const auto u = static_cast<float>(step * k * std::cos(turn));
      const auto v = static_cast<float>(step * k * std::sin(turn));
      patch.sample[j][k - 1] = {u, v, height(u, v), 0};
    }
  return patch;
}

TEST(PolarPatchTest, TheFitIsExactOnQuartics) {
  const PolarPatch patch = graph_patch(
      [](float u, float v) {
        return 0.2f * u * u - 0.1f * u * v + 0.1f * u * u * u - 0.05f * u * v * v +
               0.03f * u * u * u * u - 0.02f * u * u * v * v;
      },
      0.5f);
  const PatchDerivatives d = fit(patch, 0.5f);
  EXPECT_NEAR(d.ru.x(), 1, 1e-5);
  EXPECT_NEAR(d.rv.y(), 1, 1e-5);
  EXPECT_NEAR(d.ru.z(), 0, 1e-5);
  EXPECT_NEAR(d.ruu.z(), 0.4, 1e-4);
  EXPECT_NEAR(d.ruv.z(), -0.1, 1e-4);
  EXPECT_NEAR(d.rvv.z(), 0, 1e-4);
}

// The heat equation (4.6), as for semigeodesic patches.
TEST(PolarPatchTest, SmoothingLiftsByHalfTheLaplacian) {
  const PolarPatch patch =
      graph_patch([](float u, float v) { return 0.15f * u * u + 0.25f * v * v; }, 2);
  EXPECT_NEAR(patch.paired_mean().z(), gaussian_filters().variance * 4 * 0.8 / 2, 1e-4);
}

TEST(PolarPatchTest, RaysEndAtTheBoundary) {
  const PreparedSurface s(shapes::plane(20, 20));
  const std::int32_t v = s.nearest({10, 0, 0});
  PolarPatch patch;
  trace_polar_patch(s.sampled(), v, first_edge(s.mesh(), v), 1, patch);
  EXPECT_FALSE(patch.whole());
  EXPECT_NEAR(patch.completeness(), 0.58, 0.06);  // the rim's own rays may go either way
  EXPECT_LT(std::abs(patch.paired_mean().x()), 1e-5);
  EXPECT_LT(patch.samples().size(), 45u);
}

}  // namespace
}  // namespace semigeo::kernels
