#pragma once

#include <optional>

#include "kernels/patch/patch_derivatives.hpp"
#include "kernels/patch/patch_samples.hpp"

namespace semigeo::kernels {

/// Most noise, in multiples of a whole patch's, that the second derivatives of a truncated patch
/// may carry for the sake of a fit of degree 4. A rim's own vertices are beyond it (about 20),
/// their neighbours are not (about 4).
inline constexpr double kMaxNoiseGain = 16;

/// What `convolve` is for whole patches, of a truncated one, but for r, which is zero; nothing if
/// too few samples exist, or too badly spread, to determine second derivatives. Least squares with
/// a quadratic and Gaussian weights of sigma 1, which for a whole patch equals the convolution.
std::optional<PatchDerivatives> fit_quadratic(const PatchSamples& samples, float step);

/// What `fit` is for whole patches, of a truncated one, but for r: least squares with a polynomial
/// of degree 4; nothing where that would amplify noise by more than `kMaxNoiseGain`.
std::optional<PatchDerivatives> fit_quartic(const PatchSamples& samples, float step);

}  // namespace semigeo::kernels
