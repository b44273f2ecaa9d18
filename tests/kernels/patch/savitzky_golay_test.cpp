#include "kernels/patch/savitzky_golay.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace semigeo::kernels {
namespace {

/// What the filter of one derivative makes of u^p v^q.
double moment(float SavitzkyGolayFilters::Tap::*weight, int p, int q) {
  double sum = 0;
  for (const auto& tap : savitzky_golay_filters().taps())
    sum += tap.*weight * std::pow(tap.sample / kTaps - kReach, p) *
           std::pow(tap.sample % kTaps - kReach, q);
  return sum;
}

// Applied to u^p v^q up to degree 4 the filters give the derivatives at 0.
TEST(SavitzkyGolayTest, AreExactOnQuartics) {
  using Tap = SavitzkyGolayFilters::Tap;
  for (int p = 0; p <= 4; ++p)
    for (int q = 0; p + q <= 4; ++q) {
      const auto is = [&](int u, int v) { return p == u && q == v ? 1.0 : 0.0; };
      EXPECT_NEAR(moment(&Tap::u, p, q), is(1, 0), 1e-5) << p << q;
      EXPECT_NEAR(moment(&Tap::v, p, q), is(0, 1), 1e-5) << p << q;
      EXPECT_NEAR(moment(&Tap::uu, p, q), 2 * is(2, 0), 2e-5) << p << q;
      EXPECT_NEAR(moment(&Tap::uv, p, q), is(1, 1), 2e-5) << p << q;
      EXPECT_NEAR(moment(&Tap::vv, p, q), 2 * is(0, 2), 2e-5) << p << q;
    }
}

// What the choice of sigma and radius is for.
TEST(SavitzkyGolayTest, LetPassAboutAsMuchNoiseAsTheGaussian) {
  const auto squared = [](const std::array<float, kTaps>& filter) {
    double sum = 0;
    for (const float tap : filter) sum += static_cast<double>(tap) * tap;
    return sum;
  };
  const GaussianFilters& g = gaussian_filters();
  double mixed = 0;
  for (const auto& tap : savitzky_golay_filters().taps())
    mixed += static_cast<double>(tap.uv) * tap.uv;
  EXPECT_NEAR(savitzky_golay_filters().noise() / (squared(g.second) * squared(g.smooth)), 1.49,
              0.05);
  EXPECT_NEAR(mixed / (squared(g.first) * squared(g.first)), 1.50, 0.05);
}

}  // namespace
}  // namespace semigeo::kernels
