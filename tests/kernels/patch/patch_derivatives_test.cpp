#include "kernels/patch/patch_derivatives.hpp"

#include <gtest/gtest.h>

#include "tests/support/graph_patch.hpp"

namespace semigeo::kernels {
namespace {

TEST(PatchDerivativesTest, AreExactOnQuadratics) {
  for (const float step : {0.01f, 1.0f, 30.0f}) {
    const Patch patch = quadratic_patch(0.3f, -0.2f, 0.5f, step);
    for (const PatchDerivatives& d : {convolve(patch, step), fit(patch, step)}) {
      EXPECT_NEAR(d.ru.x(), 1, 1e-5);
      EXPECT_NEAR(d.rv.y(), 1, 1e-5);
      EXPECT_NEAR(d.ruu.z(), 0.3, 1e-5);
      EXPECT_NEAR(d.ruv.z(), -0.2, 1e-5);
      EXPECT_NEAR(d.rvv.z(), 0.5, 1e-5);
    }
  }
}

// Smoothing lifts the middle by variance / 2 times the Laplacian: the heat equation (4.6).
TEST(PatchDerivativesTest, ConvolutionSmooths) {
  for (const float step : {0.01f, 1.0f, 30.0f}) {
    const Patch patch = quadratic_patch(0.3f, -0.2f, 0.5f, step);
    const double lift = gaussian_filters().variance * step * step * 0.8 / 2;
    EXPECT_NEAR(convolve(patch, step).r.z(), lift, 1e-4 * step * step);
  }
}

TEST(PatchDerivativesTest, TheFitIsExactOnQuartics) {
  const Patch patch = graph_patch(
      [](float u, float v) {
        return 0.2f * u * u + 0.1f * u * u * u - 0.05f * u * v * v + 0.03f * u * u * u * u -
               0.02f * u * u * v * v + 0.04f * v * v * v * v;
      },
      0.5f);
  const PatchDerivatives d = fit(patch, 0.5f);
  EXPECT_NEAR(d.ru.z(), 0, 2e-5);
  EXPECT_NEAR(d.rv.z(), 0, 2e-5);
  EXPECT_NEAR(d.ruu.z(), 0.4, 1e-4);
  EXPECT_NEAR(d.ruv.z(), 0, 1e-4);
  EXPECT_NEAR(d.rvv.z(), 0, 1e-4);
  EXPECT_GT(convolve(patch, 0.5f).ruu.z(), 0.42f);
}

}  // namespace
}  // namespace semigeo::kernels
