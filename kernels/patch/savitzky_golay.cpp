#include "kernels/patch/savitzky_golay.hpp"

#include <cmath>

#include "kernels/patch/derivative_filters.hpp"

namespace semigeo::kernels {

SavitzkyGolayFilters::SavitzkyGolayFilters() {
  PatchSamples samples;
  for (int c = 0; c < kTaps; ++c)
    for (int r = 0; r < kTaps; ++r) {
      const int u = c - kReach;
      const int v = r - kReach;
      if (std::hypot(u, v) > kFitRadius) continue;
      taps_[samples.size()].sample = c * kTaps + r;
      samples.push_back({static_cast<float>(u), static_cast<float>(v), 1, Eigen::Vector4f::Zero()});
    }
  const DerivativeFilters filters = quartic_filters(samples, kFitSigma, 0).value();
  count_ = samples.size();
  for (std::size_t i = 0; i < count_; ++i) {
    const auto weights = filters.row(static_cast<Eigen::Index>(i)).cast<float>().eval();
    taps_[i] = {taps_[i].sample, weights[0], weights[1], weights[2], weights[3], weights[4]};
  }
  noise_ = filters.col(2).squaredNorm();
}

const SavitzkyGolayFilters& savitzky_golay_filters() {
  static const SavitzkyGolayFilters filters;
  return filters;
}

}  // namespace semigeo::kernels
