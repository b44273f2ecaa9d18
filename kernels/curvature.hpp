#pragma once

#include <Eigen/Core>

#include "kernels/patch.hpp"

namespace semigeo::kernels {

/// The Gaussian derivatives of a patch at its vertex, per unit length (u and v in the units of the
/// points): R = r * G relative to the vertex, R_u = r * G_u and so on.
struct PatchDerivatives {
  Eigen::Vector3f r, ru, rv, ruu, ruv, rvv;
};

/// Convolves a whole patch with the 9 x 9 Gaussian and its derivatives. Source: thesis (4.4),
/// (4.11).
PatchDerivatives convolve(const Patch& patch, float step);

/// The same for a truncated patch: `ok` is false if too few samples exist, or too badly spread, to
/// determine the second derivatives; r is valid in any case.
/// Derivatives: Gaussian-weighted least squares with a quadratic, which for a whole patch equals
/// `convolve`. Position: the Gaussian mean over pairs of opposite samples that both exist, the rest
/// of the weight staying on the vertex. Differs: thesis 5.2 skips such vertices. A mean over all
/// existing samples would pull rims inwards by a step per pass, and the intercept of a linear fit
/// amplifies waves along curved rims; this mean leaves planes alone, stays in the convex hull
/// (Theorem 2) and cannot amplify anything.
struct TruncatedDerivatives {
  PatchDerivatives derivatives;
  bool ok;
};
TruncatedDerivatives fit_truncated(const Patch& patch, float step);

/// K in length^-2, H in length^-1, negative where the surface is convex seen from outside (a sphere
/// of radius r has H = -1 / r), and the unit normal along r_u x r_v.
struct Curvature {
  float gaussian;
  float mean;
  Eigen::Vector3f normal;
};

/// From the first and second fundamental forms in full. All zero if r_u and r_v are parallel.
/// Source: thesis A.2, A.2.2.
Curvature curvature_from_forms(const PatchDerivatives& d);

/// For exact semigeodesic coordinates, E = 1 and F = 0. Source: thesis (4.9), (4.10).
Curvature curvature_semigeodesic(const PatchDerivatives& d);

}  // namespace semigeo::kernels
