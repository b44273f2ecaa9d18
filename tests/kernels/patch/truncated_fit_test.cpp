#include "kernels/patch/truncated_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>
#include <string>

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

/// Compares derivatives, in multiples of a step.
void expect_near(const std::optional<PatchDerivatives>& fast,
                 const std::optional<PatchDerivatives>& exact, const std::string& what) {
  ASSERT_EQ(fast.has_value(), exact.has_value()) << what;
  if (!exact) return;
  EXPECT_LT((fast->ru - exact->ru).norm(), 1e-5f) << what;
  EXPECT_LT((fast->rv - exact->rv).norm(), 1e-5f) << what;
  EXPECT_LT((fast->ruu - exact->ruu).norm(), 1e-5f) << what;
  EXPECT_LT((fast->ruv - exact->ruv).norm(), 1e-5f) << what;
  EXPECT_LT((fast->rvv - exact->rvv).norm(), 1e-5f) << what;
}

TEST(TruncatedFitTest, SumsOverTheLatticeEqualSumsOverTheSamples) {
  std::mt19937 random(3);
  const auto draw = [&](int low, int high) {
    return static_cast<std::int8_t>(std::uniform_int_distribution<int>(low, high)(random));
  };
  std::normal_distribution<float> noise(0, 0.3f);
  int determined = 0;
  for (int round = 0; round < 500; ++round) {
    Patch patch = quadratic_patch(0.1f, 0.2f, -0.1f, 1);
    const int left = draw(0, kReach), right = draw(0, kReach);
    for (int c = 0; c < kTaps; ++c) {
      const bool exists = kReach - c <= left && c - kReach <= right;
      patch.reach_up[c] = exists ? draw(0, kReach) : std::int8_t{-1};
      patch.reach_down[c] = exists ? draw(0, kReach) : std::int8_t{-1};
      for (auto& sample : patch.sample[c]) sample.z() += noise(random);
    }
    const std::string what = "round " + std::to_string(round);
    expect_near(fit_quadratic(patch, 1), fit_quadratic(patch.samples(), 1), what);
    expect_near(fit_quartic(patch, 1), fit_quartic(patch.samples(), 1), what);
    determined += fit_quartic(patch, 1).has_value();
  }
  EXPECT_GT(determined, 100);
}

}  // namespace
}  // namespace semigeo::kernels
