#include "kernels/patch/gaussian.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace semigeo::kernels {
namespace {

double moment(const std::array<float, kTaps>& filter, int power) {
  double sum = 0;
  for (int k = 0; k < kTaps; ++k) sum += filter[k] * std::pow(k - kReach, power);
  return sum;
}

// Applied to 1, u, u^2 the filters give the smoothed value and the derivatives at 0, exactly.
TEST(GaussianFiltersTest, AreExactOnQuadratics) {
  const GaussianFilters& g = gaussian_filters();
  EXPECT_NEAR(moment(g.smooth, 0), 1, 1e-6);
  EXPECT_NEAR(moment(g.smooth, 1), 0, 1e-6);
  EXPECT_NEAR(moment(g.smooth, 2), g.variance, 1e-6);
  EXPECT_NEAR(moment(g.first, 0), 0, 1e-6);
  EXPECT_NEAR(moment(g.first, 1), 1, 1e-6);
  EXPECT_NEAR(moment(g.first, 2), 0, 1e-6);
  EXPECT_NEAR(moment(g.second, 0), 0, 1e-6);
  EXPECT_NEAR(moment(g.second, 1), 0, 1e-6);
  EXPECT_NEAR(moment(g.second, 2), 2, 2e-6);
}

// The truncated, sampled Gaussian of sigma 1 has very nearly variance 1.
TEST(GaussianFiltersTest, SampleTheUnitGaussian) {
  const GaussianFilters& g = gaussian_filters();
  EXPECT_NEAR(g.variance, 1, 2e-3);
  for (int k = 0; k < kTaps; ++k) {
    const double u = k - kReach;
    EXPECT_NEAR(g.smooth[k], std::exp(-u * u / 2) / std::sqrt(2 * M_PI), 1e-4);
    EXPECT_NEAR(g.second[k], (u * u - 1) * g.smooth[k], 2e-3);
  }
}

}  // namespace
}  // namespace semigeo::kernels
