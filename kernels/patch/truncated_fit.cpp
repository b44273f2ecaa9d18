#include "kernels/patch/truncated_fit.hpp"

#include "kernels/patch/derivative_filters.hpp"
#include "kernels/patch/savitzky_golay.hpp"

namespace semigeo::kernels {
namespace {

constexpr double kMinQuadraticPivot = 2e-3;
constexpr double kMinQuarticPivot = 1e-8;
/// The sigma of the weights of the quartic, in steps. Less than a whole patch's: on the side
/// without samples the fit extrapolates, and far samples add more bias than they take noise.
constexpr double kRimSigma = 1.4;

}  // namespace

std::optional<PatchDerivatives> fit_quadratic(const PatchSamples& samples, float step) {
  const auto filters = quadratic_filters(samples, 1, kMinQuadraticPivot);
  if (!filters) return std::nullopt;
  return apply(*filters, samples, step);
}

std::optional<PatchDerivatives> fit_quartic(const PatchSamples& samples, float step) {
  const auto filters = quartic_filters(samples, kRimSigma, kMinQuarticPivot);
  if (!filters) return std::nullopt;
  const double variance = filters->rightCols<3>().colwise().squaredNorm().maxCoeff();
  if (!(variance <= kMaxNoiseGain * kMaxNoiseGain * savitzky_golay_filters().noise()))
    return std::nullopt;
  return apply(*filters, samples, step);
}

}  // namespace semigeo::kernels
