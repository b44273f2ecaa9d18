#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace semigeo::kernels {

/// Tells the scale at which features have become stable.
struct ScaleSelection {
  std::vector<double> smoothed;  ///< The counts, smoothed along the levels.
  int level = 0;                 ///< The level where the smoothed counts change least.
};

/// Chooses a level from the number of features on each level. The counts are smoothed along the
/// levels by a Gaussian with a sigma of one level, truncated and renormalised at the ends. The
/// level of least slope is taken, the lowest of several. The slope of a level is that between its
/// neighbours, at the ends that to its only neighbour. Levels without features, and those beside
/// them, are not taken, since a surface that has vanished is stable, too. Source: thesis 5.8.
ScaleSelection select_scale(std::span<const std::int64_t> feature_counts);

}  // namespace semigeo::kernels
