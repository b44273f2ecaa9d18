#include "kernels/patch/patch_derivatives.hpp"

#include "kernels/patch/savitzky_golay.hpp"

namespace semigeo::kernels {

PatchDerivatives convolve(const Patch& patch, float step) {
  const GaussianFilters& g = gaussian_filters();
  Eigen::Vector4f r, ru, rv, ruu, ruv, rvv;
  r = ru = rv = ruu = ruv = rvv = Eigen::Vector4f::Zero();
  for (int c = 0; c < kTaps; ++c) {
    // Separable: first along the column (v), then across the columns (u).  (4.4), (4.11)
    Eigen::Vector4f s0, s1, s2;
    s0 = s1 = s2 = Eigen::Vector4f::Zero();
    for (int k = 0; k < kTaps; ++k) {
      const Eigen::Vector4f& p = patch.sample[c][k];
      s0 += g.smooth[k] * p;
      s1 += g.first[k] * p;
      s2 += g.second[k] * p;
    }
    r += g.smooth[c] * s0;
    ru += g.first[c] * s0;
    ruu += g.second[c] * s0;
    rv += g.smooth[c] * s1;
    ruv += g.first[c] * s1;
    rvv += g.smooth[c] * s2;
  }
  const float s1 = 1 / step;
  const float s2 = s1 * s1;
  return {r.head<3>(),        ru.head<3>() * s1,  rv.head<3>() * s1,
          ruu.head<3>() * s2, ruv.head<3>() * s2, rvv.head<3>() * s2};
}

PatchDerivatives fit(const Patch& patch, float step) {
  Eigen::Vector4f ru, rv, ruu, ruv, rvv;
  ru = rv = ruu = ruv = rvv = Eigen::Vector4f::Zero();
  const Eigen::Vector4f* samples = patch.sample.front().data();
  for (const SavitzkyGolayFilters::Tap& tap : savitzky_golay_filters().taps()) {
    const Eigen::Vector4f& p = samples[tap.sample];
    ru += tap.u * p;
    rv += tap.v * p;
    ruu += tap.uu * p;
    ruv += tap.uv * p;
    rvv += tap.vv * p;
  }
  const float s1 = 1 / step;
  const float s2 = s1 * s1;
  return {Eigen::Vector3f::Zero(), ru.head<3>() * s1,  rv.head<3>() * s1,
          ruu.head<3>() * s2,      ruv.head<3>() * s2, rvv.head<3>() * s2};
}

}  // namespace semigeo::kernels
