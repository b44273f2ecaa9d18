#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "kernels/patch/patch.hpp"
#include "kernels/patch/patch_derivatives.hpp"

namespace semigeo::kernels {

/// The number of rays of a polar patch. They make eight lines through the vertex, each with as many
/// samples as an axis of a semigeodesic patch; all together that is 65 samples.
inline constexpr int kRays = 16;

/// Returns the cosine and sine of the angle of every ray.
const std::array<Eigen::Vector2f, kRays>& ray_directions();

/// Holds the samples of a geodesic polar patch (thesis 4.1.3). Ray j leaves the vertex at the angle
/// 2 pi j / kRays from the first edge, and has samples at distances 1 ... reach[j] steps. Positions
/// are relative to the vertex, as (x, y, z, 0); the vertex itself is no sample.
struct PolarPatch {
  std::array<std::array<Eigen::Vector4f, kReach>, kRays> sample;  ///< [ray][distance - 1]
  std::array<std::int8_t, kRays> reach;

  /// Tells whether all samples exist.
  bool whole() const;
  /// Returns the share of the Gaussian's weight that falls on existing samples: 1 for a whole
  /// patch.
  float completeness() const;
  /// Returns the smoothed position of the vertex, as `Patch::paired_mean` does: a 1-D convolution
  /// along each line through the vertex (5.4, 5.5), over pairs of opposite samples that both exist,
  /// averaged over the lines.
  Eigen::Vector3f paired_mean() const;
  /// Returns the existing samples and the vertex.
  PatchSamples samples() const;
};

/// Returns the weight of one sample at each distance 0 ... kReach: the Gaussian integrated over the
/// sector that lies half a step around the sample. The sigma is chosen so that the variance along
/// an axis is that of `gaussian_filters()`, and both kinds of patches smooth alike. The weights of
/// all samples together are 1.
const std::array<float, kReach + 1>& polar_weights();

/// Returns the derivatives of the smoothed surface at a whole polar patch, as `convolve` does for
/// semigeodesic patches, by least squares over its samples; r is zero.
PatchDerivatives convolve_tangents(const PolarPatch& patch, float step);
/// Returns the derivatives of the surface itself at a whole polar patch, as `fit` does for
/// semigeodesic patches, by least squares over its samples; r is zero.
PatchDerivatives fit(const PolarPatch& patch, float step);

/// Samples the geodesic polar coordinates of vertex v, along geodesics that leave it at equal
/// angles about its normal W, the first one along `first`. (u, v, outward normal) is right-handed
/// for u along the first ray. Source: thesis 5.4.
void trace_polar_patch(const SampledSurface& surface, std::int32_t v, std::int32_t first,
                       float step, PolarPatch& patch);

}  // namespace semigeo::kernels
