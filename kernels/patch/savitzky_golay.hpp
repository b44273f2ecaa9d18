#pragma once

#include <array>
#include <span>

#include "kernels/patch/gaussian.hpp"

namespace semigeo::kernels {

/// The sigma, in steps, of the weights of the least squares behind the filters. With it and
/// `kFitRadius` the filters let pass about as much noise as the derivatives of the Gaussian of
/// sigma 1 do: 0.30 against 0.25 of the points' noise in r_uu, 0.17 against 0.14 in r_uv, per
/// step^2.
inline constexpr double kFitSigma = 1.6;
/// The radius, in steps, within which samples count.
inline constexpr double kFitRadius = 4.3;

/// Holds derivative filters over a whole patch, for unit step. They give the derivatives at the
/// vertex of the polynomial of degree 4 that fits the samples best, by least squares with Gaussian
/// weights over a disc, and are exact on polynomials of degree 4.
class SavitzkyGolayFilters {
 public:
  /// The weights of one sample.
  struct Tap {
    int sample;  ///< column * kTaps + row.
    float u, v, uu, uv, vv;
  };

  SavitzkyGolayFilters();
  std::span<const Tap> taps() const { return {taps_.data(), count_}; }
  /// Returns the variance of r_uu for samples with noise of variance 1.
  double noise() const { return noise_; }

 private:
  std::array<Tap, kTaps * kTaps> taps_{};
  std::size_t count_ = 0;
  double noise_ = 0;
};

/// Returns the filters. Differs: the thesis differentiates the smoothed surface (4.11), whose
/// curvature is off by step^2 / r^2; these differentiate the surface itself, with an error of the
/// fourth order, at the same noise and the same cost.
const SavitzkyGolayFilters& savitzky_golay_filters();

}  // namespace semigeo::kernels
