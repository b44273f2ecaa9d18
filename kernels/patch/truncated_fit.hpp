#pragma once

#include <optional>

#include "kernels/patch/patch.hpp"
#include "kernels/patch/patch_derivatives.hpp"
#include "kernels/patch/patch_samples.hpp"

namespace semigeo::kernels {

/// The most noise, in multiples of that of a whole patch, that the second derivatives of a
/// truncated patch may carry for the sake of a fit of degree 4. Vertices of a rim have more (about
/// 20), their neighbours less (about 4).
inline constexpr double kMaxNoiseGain = 16;

/// Returns the derivatives of the smoothed surface at a truncated patch, by least squares with a
/// polynomial of degree 2 and Gaussian weights of sigma 1. For a whole patch that equals
/// `convolve`. r is zero. The result is empty if too few samples exist, or too badly spread, to
/// determine second derivatives.
std::optional<PatchDerivatives> fit_quadratic(const PatchSamples& samples, float step);
/// Returns the same for a semigeodesic patch, three times as fast: its samples lie on a lattice,
/// and sums over them are products of sums along u and along v.
std::optional<PatchDerivatives> fit_quadratic(const Patch& patch, float step);

/// Returns the derivatives of the surface itself at a truncated patch, by least squares with a
/// polynomial of degree 4; r is zero. The result is empty where that would amplify noise by more
/// than `kMaxNoiseGain`.
std::optional<PatchDerivatives> fit_quartic(const PatchSamples& samples, float step);
/// Returns the same for a semigeodesic patch, faster as well.
std::optional<PatchDerivatives> fit_quartic(const Patch& patch, float step);

}  // namespace semigeo::kernels
