#include "kernels/savitzky_golay.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace semigeo::kernels {
namespace {

double moment(const std::array<float, kTaps>& filter, int power) {
  double sum = 0;
  for (int k = 0; k < kTaps; ++k) sum += filter[k] * std::pow(k - kReach, power);
  return sum;
}

double norm(const std::array<float, kTaps>& filter) {
  double sum = 0;
  for (const float tap : filter) sum += static_cast<double>(tap) * tap;
  return std::sqrt(sum);
}

// Applied to 1, u, u^2, ... the filters give value and derivatives at 0.
TEST(SavitzkyGolayTest, AreExactOnQuartics) {
  const SavitzkyGolayFilters& s = savitzky_golay_filters();
  const double value[] = {1, 0, 0, 0};
  const double first[] = {0, 1, 0, 0, 0};
  const double second[] = {0, 0, 2, 0, 0, 0};
  for (int p = 0; p < 4; ++p) EXPECT_NEAR(moment(s.value, p), value[p], 1e-5) << p;
  for (int p = 0; p < 5; ++p) EXPECT_NEAR(moment(s.first, p), first[p], 1e-5) << p;
  for (int p = 0; p < 6; ++p) EXPECT_NEAR(moment(s.second, p), second[p], 1e-4) << p;
}

// What the choice of sigma is for.
TEST(SavitzkyGolayTest, LetPassAsMuchNoiseAsTheGaussian) {
  const GaussianFilters& g = gaussian_filters();
  const SavitzkyGolayFilters& s = savitzky_golay_filters();
  EXPECT_NEAR(norm(s.second) * norm(s.value) / (norm(g.second) * norm(g.smooth)), 1, 0.06);
  EXPECT_NEAR(std::pow(norm(s.first) / norm(g.first), 2), 1, 0.06);
}

}  // namespace
}  // namespace semigeo::kernels
