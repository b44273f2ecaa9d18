#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace semigeo::kernels {

/// Describes a point of a polyline. It lies between point `segment` and the next one. After the
/// last point of a closed polyline comes the first one.
struct ArcPoint {
  std::int32_t segment = 0;
  float fraction = 0;  ///< 0 at point `segment`, 1 at the next one.
};

/// Holds a polyline in equal steps of arc length.
struct ArcSamples {
  std::vector<ArcPoint> at;
  double spacing = 0;  ///< Distance of neighbours, in the units of the points.
};

/// Cuts a polyline into equal pieces as near to `spacing` as their number allows. An open polyline
/// keeps both its ends; a closed one begins at its first point and has at least three samples. A
/// polyline without length has one sample.
ArcSamples resample(std::span<const Eigen::Vector3d> points, bool closed, double spacing);

/// Returns the length of a polyline, in the units of its points. If it is closed, the length
/// includes the segment from the last point to the first. A polyline of fewer than two points has
/// length 0.
double length_of(std::span<const Eigen::Vector3d> points, bool closed);

/// Returns the torsion at each of the equidistant samples of a curve, in 1 / units of the samples.
/// The curve is convolved with the first three derivatives of a Gaussian whose sigma is one sample
/// distance. Torsion is positive where the curve winds like a right-handed screw. It is 0 where it
/// cannot be computed: within four samples of an open end, on closed curves of less than nine
/// samples, and where the curve is straight.
/// Source: thesis 4.4, (4.13) - (4.15). Differs: (4.14) is taken as
/// ((r' x r'') . r''') / |r' x r''|^2; in the text it has lost its third derivatives.
std::vector<float> torsion(std::span<const Eigen::Vector3d> samples, bool closed);

/// Returns the samples whose |torsion| exceeds that of both neighbours. Source: thesis 5.7.
std::vector<std::int32_t> torsion_maxima(std::span<const float> torsion, bool closed);

/// Returns the prominence of each sample: how far |torsion| falls on the easier of the two ways to
/// a higher one, or the whole |torsion| where there is none. The cost is linear.
std::vector<float> torsion_prominences(std::span<const float> torsion, bool closed);

}  // namespace semigeo::kernels
