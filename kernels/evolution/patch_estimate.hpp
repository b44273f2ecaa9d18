#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "kernels/evolution/evolution.hpp"
#include "kernels/patch/patch_derivatives.hpp"
#include "kernels/patch/polar_patch.hpp"

namespace semigeo::kernels {

/// Holds what a patch determines, whole or not.
struct PatchEstimate {
  Eigen::Vector3f moved;      ///< Smoothed position, relative to the vertex.
  PatchDerivatives smoothed;  ///< Of the smoothed surface; only the tangents count.
  PatchDerivatives fitted;    ///< Of the surface itself.
  float completeness;         ///< Share of the Gaussian's weight on samples that exist.
  bool valid;                 ///< Whether the samples determine a curvature.
};

/// Returns what a semigeodesic patch determines: by convolution if it is whole, else by least
/// squares over the samples that exist.
PatchEstimate estimate(const Patch& patch, float step);
/// Returns what a polar patch determines.
PatchEstimate estimate(const PolarPatch& patch, float step);

/// Returns the results for vertex v from what its patch determines, as `evolve_vertex` describes
/// them. An invalid estimate, or one that is not finite, leaves normal and curvature as they were.
EvolvedVertex evolved_vertex(const SampledSurface& surface, std::int32_t v,
                             const PatchLayout& layout, const PatchEstimate& estimate);

}  // namespace semigeo::kernels
