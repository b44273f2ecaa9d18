#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace semigeo::kernels {

/// A point of a polyline: so far from point `segment` to the next one (of a closed polyline's last
/// point: to the first).
struct ArcPoint {
  std::int32_t segment = 0;
  float fraction = 0;
};

/// A polyline in equal steps of arc length.
struct ArcSamples {
  std::vector<ArcPoint> at;
  double spacing = 0;  ///< between neighbours, units of the points
};

/// Cuts a polyline into equal pieces as near to `spacing` as their number allows. An open one keeps
/// both its ends; a closed one begins at its first point and has three samples at least. Without
/// length: one sample.
ArcSamples resample(std::span<const Eigen::Vector3d> points, bool closed, double spacing);

/// Total length, with the way back to the first point if closed.
double length_of(std::span<const Eigen::Vector3d> points, bool closed);

/// Torsion at each of the equidistant samples of a curve, in 1 / units of the samples: the curve is
/// convolved with the first three derivatives of a Gaussian whose sigma is one sample distance.
/// Positive where the curve winds like a right-handed screw. 0 where it cannot be had: within four
/// samples of an open end, on closed curves of less than nine, and where the curve is straight.
/// Source: thesis 4.4, (4.13) - (4.15). Differs: (4.14) is taken as
/// ((r' x r'') . r''') / |r' x r''|^2; in the text it has lost its third derivatives.
std::vector<float> torsion(std::span<const Eigen::Vector3d> samples, bool closed);

/// Samples whose |torsion| exceeds that of both neighbours. Source: thesis 5.7.
std::vector<std::int32_t> torsion_maxima(std::span<const float> torsion, bool closed);

/// How far |torsion| falls from each sample on the easier of the two ways to a higher one; all of
/// it where there is none. Linear cost.
std::vector<float> torsion_prominences(std::span<const float> torsion, bool closed);

}  // namespace semigeo::kernels
