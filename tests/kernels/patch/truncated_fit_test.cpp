#include "kernels/patch/truncated_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/evolution/curvature.hpp"
#include "tests/support/graph_patch.hpp"

namespace semigeo::kernels {
namespace {

/// What is left of a patch of vertex 0 in the half-plane v >= -rows.
Patch cut(Patch patch, int rows) {
  for (int c = 0; c < kTaps; ++c) patch.reach_down[c] = static_cast<std::int8_t>(rows);
  return patch;
}

TEST(FitQuadraticTest, EqualsTheConvolutionOnAWholePatch) {
  const Patch patch = graph_patch(
      [](float u, float v) { return 0.3f * u * u - 0.2f * u * v + 0.1f * u * u * v * v; }, 0.5f);
  const PatchDerivatives d = convolve(patch, 0.5f);
  const auto t = fit_quadratic(patch.samples(), 0.5f);
  ASSERT_TRUE(t);
  EXPECT_LT((t->ru - d.ru).norm(), 1e-5);
  EXPECT_LT((t->ruu - d.ruu).norm(), 1e-5);
  EXPECT_LT((t->ruv - d.ruv).norm(), 1e-5);
  EXPECT_LT((t->rvv - d.rvv).norm(), 1e-5);
  EXPECT_LT((patch.paired_mean() - d.r).norm(), 1e-5);
}

TEST(FitQuadraticTest, HalfAPatchStillKnowsTheCurvature) {
  Patch patch = quadratic_patch(-2, 0.4f, -0.5f, 0.1f);
  for (int c = kReach + 1; c < kTaps; ++c) patch.reach_up[c] = patch.reach_down[c] = -1;
  const auto t = fit_quadratic(patch.samples(), 0.1f);
  ASSERT_TRUE(t);
  const Curvature c = curvature_from_forms(*t);
  EXPECT_NEAR(c.gaussian, 1 - 0.16, 2e-3);
  EXPECT_NEAR(c.mean, -1.25, 2e-3);
}

TEST(FitQuadraticTest, ALineOfSamplesHasNoCurvature) {
  Patch patch = quadratic_patch(1, 0, 1, 1);
  patch.reach_up.fill(0);
  patch.reach_down.fill(0);
  EXPECT_FALSE(fit_quadratic(patch.samples(), 1));
  EXPECT_FALSE(fit_quartic(patch.samples(), 1));
}

TEST(FitQuarticTest, IsExactOnQuarticsWhereSamplesAreMissing) {
  const Patch whole = graph_patch(
      [](float u, float v) {
        return 0.2f * u * u - 0.1f * u * v + 0.15f * v * v + 0.1f * v * v * v +
               0.03f * u * u * v * v + 0.04f * v * v * v * v;
      },
      0.5f);
  for (const int rows : {4, 2, 1}) {
    const auto d = fit_quartic(cut(whole, rows).samples(), 0.5f);
    ASSERT_TRUE(d) << rows;
    EXPECT_NEAR(d->rv.z(), 0, 1e-4);
    EXPECT_NEAR(d->ruu.z(), 0.4, 1e-3);
    EXPECT_NEAR(d->ruv.z(), -0.1, 1e-3);
    EXPECT_NEAR(d->rvv.z(), 0.3, 1e-3);
    EXPECT_GT(std::abs(fit_quadratic(cut(whole, rows).samples(), 0.5f)->rvv.z() - 0.3f), 0.02f);
  }
}

// On a rim itself, samples on one side only, noise would grow twentyfold.
TEST(FitQuarticTest, DeclinesWhatWouldAmplifyNoise) {
  const Patch patch = quadratic_patch(1, 0, 1, 1);
  EXPECT_TRUE(fit_quartic(cut(patch, 1).samples(), 1));
  EXPECT_FALSE(fit_quartic(cut(patch, 0).samples(), 1));
  Patch corner = cut(patch, 0);
  for (int c = 0; c < kReach; ++c) corner.reach_up[c] = corner.reach_down[c] = -1;
  EXPECT_FALSE(fit_quartic(corner.samples(), 1));
}

// On a plane nothing moves, whatever is missing: no shrinking rims.
TEST(PatchPairedMeanTest, APlaneStaysWhereItIs) {
  Patch patch = quadratic_patch(0, 0, 0, 1);
  for (int c = 0; c < kTaps; ++c) {
    patch.reach_up[c] = static_cast<std::int8_t>(c % 5);
    patch.reach_down[c] = static_cast<std::int8_t>((c * 3) % 5);
  }
  EXPECT_LT(patch.paired_mean().norm(), 1e-6);
}

}  // namespace
}  // namespace semigeo::kernels
