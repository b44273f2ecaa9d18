#pragma once

#include <Eigen/Core>

#include "kernels/patch/patch.hpp"

namespace semigeo::kernels {

/// Holds position and derivatives of a surface at the vertex of a patch, by the parameters u and v
/// of the patch in the units of the points; r is relative to the vertex.
struct PatchDerivatives {
  Eigen::Vector3f r, ru, rv, ruu, ruv, rvv;
};

/// Returns position and derivatives of the smoothed surface: a whole patch is convolved with the
/// 9 x 9 Gaussian and its derivatives, R = r * G, R_u = r * G_u and so on. Source: thesis (4.4),
/// (4.11).
PatchDerivatives convolve(const Patch& patch, float step);

/// Returns the derivatives of the surface itself: the Savitzky-Golay filters are applied to a whole
/// patch. r is zero. Differs: see `savitzky_golay_filters`.
PatchDerivatives fit(const Patch& patch, float step);

}  // namespace semigeo::kernels
