#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace semigeo::kernels {

/// The scale at which features have become stable.
struct ScaleSelection {
  std::vector<double> smoothed;  ///< the counts, smoothed along the levels
  int level = 0;                 ///< where the smoothed counts change least
};

/// Chooses a level from the number of features on each: the curve over the levels is smoothed by a
/// Gaussian of one level, truncated and renormalised at the ends, and the level of least slope is
/// taken, the lowest of several. The slope is that between the neighbours of a level; ends have
/// only one. Levels without features, and those beside them, are not taken: a surface that has
/// vanished is stable too. Source: thesis 5.8.
ScaleSelection select_scale(std::span<const std::int64_t> feature_counts);

}  // namespace semigeo::kernels
