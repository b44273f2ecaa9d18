#pragma once

#include <array>

namespace semigeo::kernels {

/// The number of samples to each side of the origin: a patch has 9 x 9 (thesis 5.5).
inline constexpr int kReach = 4;
/// The number of samples along each axis of a patch.
inline constexpr int kTaps = 2 * kReach + 1;

/// Holds the 1-D factors of the 9 x 9 Gaussian filters, for unit sample distance and sigma = 1. Tap
/// k belongs to coordinate k - kReach. They are applied as correlations: sum over k of tap[k] *
/// r[k].
struct GaussianFilters {
  std::array<float, kTaps> smooth;  ///< G: its sum is 1.
  std::array<float, kTaps> first;   ///< G': exact on polynomials of degree 2.
  std::array<float, kTaps> second;  ///< G'': exact on polynomials of degree 2.
  std::array<float, kTaps> third;   ///< G''': exact on polynomials of degree 4.
  double variance;                  ///< Second moment of `smooth`: what one pass adds, in steps^2.
};

/// Returns the filters. Source: thesis (4.5), (4.11), 5.5. Differs: the sampled derivatives are
/// normalised to be exact on polynomials of degree 2 (sum, first and second moment); sampled as
/// they stand they are wrong by up to 0.1 %, a bias of the same size as what curved samples leave.
const GaussianFilters& gaussian_filters();

}  // namespace semigeo::kernels
