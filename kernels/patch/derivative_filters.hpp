#pragma once

#include <Eigen/Core>
#include <optional>

#include "kernels/patch/patch_derivatives.hpp"
#include "kernels/patch/patch_samples.hpp"

namespace semigeo::kernels {

/// Holds linear filters over the samples of one patch. Row i has the weights of sample i in r_u,
/// r_v, r_uu, r_uv and r_vv, for unit step.
using DerivativeFilters =
    Eigen::Matrix<double, Eigen::Dynamic, 5, Eigen::RowMajor, PatchSamples::kCapacity, 5>;

/// Returns filters for the derivatives at the vertex of the polynomial of degree 2 that fits the
/// samples best, by least squares with the weight area * exp(-(u^2 + v^2) / (2 sigma^2)), sigma in
/// steps. They are exact on polynomials of that degree. The result is empty if the samples do not
/// determine the polynomial: there are fewer than it has coefficients, or a pivot is below
/// `min_pivot` of the largest.
std::optional<DerivativeFilters> quadratic_filters(const PatchSamples& samples, double sigma,
                                                   double min_pivot);
/// Returns filters as `quadratic_filters` does, with a polynomial of degree 4.
std::optional<DerivativeFilters> quartic_filters(const PatchSamples& samples, double sigma,
                                                 double min_pivot);

/// Applies filters to the samples that they were made for; `r` of the result is zero.
PatchDerivatives apply(const DerivativeFilters& filters, const PatchSamples& samples, float step);

}  // namespace semigeo::kernels
