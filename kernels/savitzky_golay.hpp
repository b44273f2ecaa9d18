#pragma once

#include <array>

#include "kernels/gaussian.hpp"

namespace semigeo::kernels {

/// Sigma, in steps, of the weights of the least squares behind the filters. At 2 they let pass as
/// much noise as the derivatives of the Gaussian of sigma 1 do: 0.26 against 0.25 of the points'
/// noise in r_uu, 0.14 against 0.14 in r_uv, per step^2.
inline constexpr double kFitSigma = 2;

/// The 1-D factors of the derivative filters over 9 taps, for unit sample distance: value and
/// derivatives at the middle of the polynomial that fits the samples best, by least squares with
/// Gaussian weights. Correlations, as `GaussianFilters`.
struct SavitzkyGolayFilters {
  std::array<float, kTaps> value;   ///< exact on polynomials of degree 3
  std::array<float, kTaps> first;   ///< exact on polynomials of degree 4
  std::array<float, kTaps> second;  ///< exact on polynomials of degree 5
};

/// Differs: the thesis differentiates the smoothed surface (4.11), whose curvature is off by
/// step^2 / r^2; these differentiate the surface itself, with an error of the fourth order, at the
/// same noise and the same cost.
const SavitzkyGolayFilters& savitzky_golay_filters();

}  // namespace semigeo::kernels
