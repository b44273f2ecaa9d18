#include "kernels/features/scale_selection.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/patch/gaussian.hpp"

namespace semigeo::kernels {

ScaleSelection select_scale(std::span<const std::int64_t> feature_counts) {
  const auto n = static_cast<int>(feature_counts.size());
  ScaleSelection result;
  for (int level = 0; level < n; ++level) {
    double sum = 0;
    double weights = 0;
    for (int k = 0; k < kTaps; ++k) {
      const int other = level + k - kReach;
      if (other < 0 || other >= n) continue;
      const double weight = gaussian_filters().smooth[k];
      sum += weight * static_cast<double>(feature_counts[other]);
      weights += weight;
    }
    result.smoothed.push_back(sum / weights);
  }
  double least = HUGE_VAL;
  for (int level = 0; level < n; ++level) {
    const int before = std::max(level - 1, 0);
    const int after = std::min(level + 1, n - 1);
    if (feature_counts[before] == 0 || feature_counts[level] == 0 || feature_counts[after] == 0)
      continue;
    if (after == before) break;
    const double slope =
        std::abs(result.smoothed[after] - result.smoothed[before]) / (after - before);
    if (!(slope < least)) continue;
    least = slope;
    result.level = level;
  }
  return result;
}

}  // namespace semigeo::kernels
