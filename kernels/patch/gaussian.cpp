#include "kernels/patch/gaussian.hpp"

#include <cmath>

namespace semigeo::kernels {
namespace {

GaussianFilters make_filters() {
  std::array<double, kTaps> g{};
  double sum = 0;
  for (int k = 0; k < kTaps; ++k) {
    const double u = k - kReach;
    g[k] = std::exp(-u * u / 2);  // (4.5), one factor, not yet normalised
    sum += g[k];
  }
  double variance = 0;
  double fourth = 0;
  double sixth = 0;
  for (int k = 0; k < kTaps; ++k) {
    const double u = k - kReach;
    g[k] /= sum;
    variance += g[k] * u * u;
    fourth += g[k] * u * u * u * u;
    sixth += g[k] * std::pow(u, 6);
  }

  GaussianFilters filters{};
  filters.variance = variance;
  for (int k = 0; k < kTaps; ++k) {
    const double u = k - kReach;
    filters.smooth[k] = static_cast<float>(g[k]);
    // d/du of sum g(u - t) r(t) weighs r by u g: scaled so that r = u gives 1.
    filters.first[k] = static_cast<float>(u * g[k] / variance);
    // (u^2 - variance) g: annihilates constants; scaled so that r = u^2 gives 2.
    filters.second[k] =
        static_cast<float>(2 * (u * u - variance) * g[k] / (fourth - variance * variance));
    // (u^3 - c u) g: annihilates r = u; scaled so that r = u^3 gives 6.
    const double linear = fourth / variance;
    filters.third[k] =
        static_cast<float>(6 * (u * u * u - linear * u) * g[k] / (sixth - linear * fourth));
  }
  return filters;
}

}  // namespace

const GaussianFilters& gaussian_filters() {
  static const GaussianFilters filters = make_filters();
  return filters;
}

}  // namespace semigeo::kernels
