#pragma once

#include <optional>

#include "kernels/patch_derivatives.hpp"

namespace semigeo::kernels {

/// Most noise, in multiples of a whole patch's, that the second derivatives of a truncated patch
/// may carry for the sake of a fit of degree 4. A rim's own vertices are beyond it (about 20),
/// their neighbours are not (about 4).
inline constexpr double kMaxNoiseGain = 16;

/// What `convolve` is for whole patches, of a truncated one; nothing if too few samples exist, or
/// too badly spread, to determine second derivatives. Least squares with a quadratic and Gaussian
/// weights of sigma 1, which for a whole patch equals the convolution; r is the fit's value.
std::optional<PatchDerivatives> fit_quadratic(const Patch& patch, float step);

/// What `fit` is for whole patches, of a truncated one: least squares with a polynomial of degree 4
/// and Gaussian weights; nothing where that would amplify noise by more than
/// `kMaxNoiseGain`.
std::optional<PatchDerivatives> fit_quartic(const Patch& patch, float step);

/// Smoothed position of a truncated patch's vertex, relative to it: the Gaussian mean over pairs of
/// opposite samples that both exist, the rest of the weight staying on the vertex.
/// Differs: thesis 5.2 skips such vertices. A mean over all existing samples would pull rims
/// inwards by a step per pass, and the intercept of a linear fit amplifies waves along curved rims;
/// this mean leaves planes alone, stays in the convex hull (Theorem 2) and cannot amplify anything.
Eigen::Vector3f paired_mean(const Patch& patch);

}  // namespace semigeo::kernels
