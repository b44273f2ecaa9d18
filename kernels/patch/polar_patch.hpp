#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "kernels/patch/patch.hpp"
#include "kernels/patch/patch_derivatives.hpp"

namespace semigeo::kernels {

/// Rays of a polar patch: as many samples along each line through the vertex as a semigeodesic
/// patch has, eight lines, 65 samples.
inline constexpr int kRays = 16;

/// The samples of a geodesic polar patch (thesis 4.1.3): ray j leaves the vertex at the angle
/// 2 pi j / kRays from the first edge, and has samples at distances 1 ... reach[j] steps. Positions
/// are relative to the vertex, as (x, y, z, 0); the vertex itself is no sample.
struct PolarPatch {
  std::array<std::array<Eigen::Vector4f, kReach>, kRays> sample;  ///< [ray][distance - 1]
  std::array<std::int8_t, kRays> reach;

  bool whole() const;
  /// Share of the Gaussian's weight that falls on existing samples: 1 for a whole patch.
  float completeness() const;
  /// As `Patch::paired_mean`: a 1-D convolution along each line through the vertex (5.4, 5.5), over
  /// pairs of opposite samples that both exist, averaged over the lines.
  Eigen::Vector3f paired_mean() const;
  /// The vertex included.
  PatchSamples samples() const;
};

/// Weight of one sample at distance 0 ... kReach: the Gaussian integrated over the sector that lies
/// half a step around it. Its sigma is chosen so that the variance along an axis is that of
/// `gaussian_filters()`, and both kinds of patches smooth alike. All samples together: 1.
const std::array<float, kReach + 1>& polar_weights();

/// What `convolve` and `fit` are for semigeodesic patches, of a whole polar patch, but for r, which
/// is zero: the same least squares over its samples.
PatchDerivatives convolve_tangents(const PolarPatch& patch, float step);
PatchDerivatives fit(const PolarPatch& patch, float step);

/// Samples the geodesic polar coordinates of vertex v: geodesics that leave it at equal angles
/// about its normal W, the first along `first`. (u, v, outward normal) is right-handed for u along
/// the first ray. Source: thesis 5.4.
void trace_polar_patch(const SampledSurface& surface, std::int32_t v, std::int32_t first,
                       float step, PolarPatch& patch);

}  // namespace semigeo::kernels
