#pragma once

#include <Eigen/Core>
#include <optional>

#include "kernels/patch/patch_derivatives.hpp"
#include "kernels/patch/patch_samples.hpp"

namespace semigeo::kernels {

/// Linear filters over the samples of one patch: row i holds the weights of sample i in r_u, r_v,
/// r_uu, r_uv, r_vv, for unit step.
using DerivativeFilters =
    Eigen::Matrix<double, Eigen::Dynamic, 5, Eigen::RowMajor, PatchSamples::kCapacity, 5>;

/// Derivatives at the vertex of the polynomial of a degree that fits the samples best: least
/// squares with the weight area * exp(-(u^2 + v^2) / (2 sigma^2)), sigma in steps. Exact on
/// polynomials of that degree. Nothing if the samples do not determine it: fewer than it has
/// coefficients, or a pivot below `min_pivot` of the largest.
std::optional<DerivativeFilters> quadratic_filters(const PatchSamples& samples, double sigma,
                                                   double min_pivot);
std::optional<DerivativeFilters> quartic_filters(const PatchSamples& samples, double sigma,
                                                 double min_pivot);

/// The filters applied; `r` is left zero.
PatchDerivatives apply(const DerivativeFilters& filters, const PatchSamples& samples, float step);

}  // namespace semigeo::kernels
