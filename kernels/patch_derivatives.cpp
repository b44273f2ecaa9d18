#include "kernels/patch_derivatives.hpp"

#include "kernels/savitzky_golay.hpp"

namespace semigeo::kernels {
namespace {

using Taps = std::array<float, kTaps>;

PatchDerivatives correlate(const Patch& patch, float step, const Taps& value, const Taps& first,
                           const Taps& second) {
  Eigen::Vector4f r, ru, rv, ruu, ruv, rvv;
  r = ru = rv = ruu = ruv = rvv = Eigen::Vector4f::Zero();
  for (int c = 0; c < kTaps; ++c) {
    // Separable: first along the column (v), then across the columns (u).  (4.4), (4.11)
    Eigen::Vector4f s0, s1, s2;
    s0 = s1 = s2 = Eigen::Vector4f::Zero();
    for (int k = 0; k < kTaps; ++k) {
      const Eigen::Vector4f& p = patch.sample[c][k];
      s0 += value[k] * p;
      s1 += first[k] * p;
      s2 += second[k] * p;
    }
    r += value[c] * s0;
    ru += first[c] * s0;
    ruu += second[c] * s0;
    rv += value[c] * s1;
    ruv += first[c] * s1;
    rvv += value[c] * s2;
  }
  const float s1 = 1 / step;
  const float s2 = s1 * s1;
  return {r.head<3>(),        ru.head<3>() * s1,  rv.head<3>() * s1,
          ruu.head<3>() * s2, ruv.head<3>() * s2, rvv.head<3>() * s2};
}

}  // namespace

PatchDerivatives convolve(const Patch& patch, float step) {
  const GaussianFilters& g = gaussian_filters();
  return correlate(patch, step, g.smooth, g.first, g.second);
}

PatchDerivatives fit(const Patch& patch, float step) {
  const SavitzkyGolayFilters& s = savitzky_golay_filters();
  return correlate(patch, step, s.value, s.first, s.second);
}

}  // namespace semigeo::kernels
