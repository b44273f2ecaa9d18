#include "kernels/savitzky_golay.hpp"

#include <Eigen/LU>
#include <cmath>

namespace semigeo::kernels {
namespace {

SavitzkyGolayFilters make_filters() {
  std::array<double, kTaps> weight{};
  std::array<double, 9> moment{};  // sum of weight * u^p; odd ones vanish
  for (int k = 0; k < kTaps; ++k) {
    const double u = k - kReach;
    weight[k] = std::exp(-u * u / (2 * kFitSigma * kFitSigma));
    for (int p = 0; p <= 8; p += 2) moment[p] += weight[k] * std::pow(u, p);
  }
  const auto& m = moment;
  // A filter is weight times a polynomial, even or odd as its derivative, of the fit's degree. Its
  // coefficients follow from the moments that it must have.
  const Eigen::Vector2d value =
      (Eigen::Matrix2d() << m[0], m[2], m[2], m[4]).finished().inverse() * Eigen::Vector2d(1, 0);
  const Eigen::Vector2d first =
      (Eigen::Matrix2d() << m[2], m[4], m[4], m[6]).finished().inverse() * Eigen::Vector2d(1, 0);
  const Eigen::Vector3d second =
      (Eigen::Matrix3d() << m[0], m[2], m[4], m[2], m[4], m[6], m[4], m[6], m[8])
          .finished()
          .inverse() *
      Eigen::Vector3d(0, 2, 0);

  SavitzkyGolayFilters filters{};
  for (int k = 0; k < kTaps; ++k) {
    const double u = k - kReach;
    const double u2 = u * u;
    filters.value[k] = static_cast<float>(weight[k] * (value[0] + value[1] * u2));
    filters.first[k] = static_cast<float>(weight[k] * u * (first[0] + first[1] * u2));
    filters.second[k] =
        static_cast<float>(weight[k] * (second[0] + second[1] * u2 + second[2] * u2 * u2));
  }
  return filters;
}

}  // namespace

const SavitzkyGolayFilters& savitzky_golay_filters() {
  static const SavitzkyGolayFilters filters = make_filters();
  return filters;
}

}  // namespace semigeo::kernels
