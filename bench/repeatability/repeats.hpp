#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <span>
#include <vector>

#include "bench/repeatability/scale_levels.hpp"

namespace semigeo::repeatability {

/// How the features of one kind, on one level, found with one radius, come back. Shares are NaN
/// where there are no features.
struct Repeats {
  std::int64_t features = 0;   ///< of the original that count
  std::int64_t found = 0;      ///< of the same kind on the changed mesh
  double share = 0;            ///< that come back: same sign, within the tolerance
  double chance = 0;           ///< what as many random points would reach
  double share_prominent = 0;  ///< of the more prominent half of the features
  double share_twice = 0;      ///< within twice the tolerance
  double share_scale = 0;      ///< within the level's scale
  double median_distance = 0;  ///< to the nearest of the same kind and sign, in tolerances
  double median_miss = 0;      ///< the same, of those that do not come back
};

struct RepeatOptions {
  double tolerance = 0;  ///< original's units
  double area = 0;       ///< of the changed surface
  double scale = 0;      ///< of the original's level
  /// Which features of the original count, by their position.
  std::function<bool(const Eigen::Vector3d&)> counts;
};

/// Compares features of one kind. Cost: the product of their numbers, at a few ns.
Repeats repeats(std::span<const PlacedFeature> original, std::span<const PlacedFeature> changed,
                const RepeatOptions& options);

/// The level whose scale is nearest in ratio; there must be one.
std::size_t nearest_level(std::span<const ScaleLevel> levels, double scale);

}  // namespace semigeo::repeatability
