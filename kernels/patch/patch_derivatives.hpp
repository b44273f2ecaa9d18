#pragma once

#include <Eigen/Core>

#include "kernels/patch/patch.hpp"

namespace semigeo::kernels {

/// Position and derivatives of a surface at the vertex of a patch, by the patch's parameters u and
/// v in the units of the points; r is relative to the vertex.
struct PatchDerivatives {
  Eigen::Vector3f r, ru, rv, ruu, ruv, rvv;
};

/// Of the smoothed surface: a whole patch convolved with the 9 x 9 Gaussian and its derivatives,
/// R = r * G, R_u = r * G_u and so on. Source: thesis (4.4), (4.11).
PatchDerivatives convolve(const Patch& patch, float step);

/// Of the surface itself, but for r, which is zero: a whole patch under the Savitzky-Golay filters.
/// Differs: see there.
PatchDerivatives fit(const Patch& patch, float step);

}  // namespace semigeo::kernels
