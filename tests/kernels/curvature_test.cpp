#include "kernels/curvature.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace semigeo::kernels {
namespace {

using Eigen::Vector3f;

/// A whole patch that samples the graph z = a u^2/2 + b u v + c v^2/2 over a plane.
Patch graph_patch(float a, float b, float c, float step) {
  Patch patch;
  patch.reach_up.fill(kReach);
  patch.reach_down.fill(kReach);
  for (int i = 0; i < kTaps; ++i)
    for (int j = 0; j < kTaps; ++j) {
      const float u = step * static_cast<float>(i - kReach);
      const float v = step * static_cast<float>(j - kReach);
      patch.sample[i][j] = {u, v, a * u * u / 2 + b * u * v + c * v * v / 2, 0};
    }
  return patch;
}

TEST(CurvatureTest, ConvolutionIsExactOnQuadratics) {
  for (const float step : {0.01f, 1.0f, 30.0f}) {
    const PatchDerivatives d = convolve(graph_patch(0.3f, -0.2f, 0.5f, step), step);
    EXPECT_NEAR(d.ru.x(), 1, 1e-5);
    EXPECT_NEAR(d.rv.y(), 1, 1e-5);
    EXPECT_NEAR(d.ruu.z(), 0.3, 1e-5);
    EXPECT_NEAR(d.ruv.z(), -0.2, 1e-5);
    EXPECT_NEAR(d.rvv.z(), 0.5, 1e-5);
    // Smoothing lifts the middle by variance / 2 times the Laplacian: the heat equation (4.6).
    EXPECT_NEAR(d.r.z(), gaussian_filters().variance * step * step * 0.8 / 2, 1e-4 * step * step);
  }
}

TEST(CurvatureTest, FormsGiveKAndHOfAGraph) {
  const Curvature c = curvature_from_forms(convolve(graph_patch(-2, 0, -0.5f, 0.1f), 0.1f));
  EXPECT_NEAR(c.gaussian, 1, 1e-4);
  EXPECT_NEAR(c.mean, -1.25, 1e-4);
  EXPECT_NEAR(c.normal.z(), 1, 1e-6);
}

// A.2: K and H do not depend on how the surface is parametrised.
TEST(CurvatureTest, FormsAreInvariantUnderReparametrisation) {
  const PatchDerivatives d = convolve(graph_patch(-2, 0.7f, -0.5f, 0.1f), 0.1f);
  PatchDerivatives skew = d;  // u' = u / 2, v' = v - 0.3 u, so r_u' = 2 (r_u + 0.3 r_v)
  skew.ru = 2 * (d.ru + 0.3f * d.rv);
  skew.ruu = 4 * (d.ruu + 0.6f * d.ruv + 0.09f * d.rvv);
  skew.ruv = 2 * (d.ruv + 0.3f * d.rvv);
  const Curvature a = curvature_from_forms(d), b = curvature_from_forms(skew);
  EXPECT_NEAR(a.gaussian, b.gaussian, 1e-4);
  EXPECT_NEAR(a.mean, b.mean, 1e-4);
}

// In orthonormal semigeodesic coordinates (4.9), (4.10) and A.2.2 agree.
TEST(CurvatureTest, SemigeodesicFormulasAgreeOnUnitCoordinates) {
  const PatchDerivatives d = convolve(graph_patch(0.4f, 0.1f, -0.5f, 0.1f), 0.1f);
  EXPECT_NEAR(curvature_semigeodesic(d).gaussian, curvature_from_forms(d).gaussian, 1e-4);
  EXPECT_NEAR(curvature_semigeodesic(d).mean, curvature_from_forms(d).mean, 1e-4);
}

TEST(CurvatureTest, ParallelTangentsGiveZeroNotNan) {
  PatchDerivatives d{};
  d.ru = d.rv = {1, 0, 0};
  EXPECT_EQ(curvature_from_forms(d).gaussian, 0);
  EXPECT_TRUE(curvature_semigeodesic(d).normal.isZero(0));
}

TEST(TruncatedTest, EqualsTheConvolutionOnAWholePatch) {
  const Patch patch = graph_patch(0.3f, -0.2f, 0.5f, 0.5f);
  const PatchDerivatives d = convolve(patch, 0.5f);
  const TruncatedDerivatives t = fit_truncated(patch, 0.5f);
  ASSERT_TRUE(t.ok);
  EXPECT_LT((t.derivatives.r - d.r).norm(), 1e-5);
  EXPECT_LT((t.derivatives.ru - d.ru).norm(), 1e-5);
  EXPECT_LT((t.derivatives.ruv - d.ruv).norm(), 1e-5);
  EXPECT_LT((t.derivatives.rvv - d.rvv).norm(), 1e-5);
}

TEST(TruncatedTest, HalfAPatchStillKnowsTheCurvature) {
  Patch patch = graph_patch(-2, 0.4f, -0.5f, 0.1f);
  for (int c = kReach + 1; c < kTaps; ++c) patch.reach_up[c] = patch.reach_down[c] = -1;
  const TruncatedDerivatives t = fit_truncated(patch, 0.1f);
  ASSERT_TRUE(t.ok);
  const Curvature c = curvature_from_forms(t.derivatives);
  EXPECT_NEAR(c.gaussian, 1 - 0.16, 2e-3);
  EXPECT_NEAR(c.mean, -1.25, 2e-3);
}

// On a plane nothing moves, whatever is missing: no shrinking rims.
TEST(TruncatedTest, APlaneStaysWhereItIs) {
  Patch patch = graph_patch(0, 0, 0, 1);
  for (int c = 0; c < kTaps; ++c) {
    patch.reach_up[c] = static_cast<std::int8_t>(c % 5);
    patch.reach_down[c] = static_cast<std::int8_t>((c * 3) % 5);
  }
  EXPECT_LT(fit_truncated(patch, 1).derivatives.r.norm(), 1e-6);
}

TEST(TruncatedTest, ALineOfSamplesHasNoCurvature) {
  Patch patch = graph_patch(1, 0, 1, 1);
  patch.reach_up.fill(0);
  patch.reach_down.fill(0);
  EXPECT_FALSE(fit_truncated(patch, 1).ok);
}

}  // namespace
}  // namespace semigeo::kernels
