#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <span>
#include <vector>

#include "bench/repeatability/scale_levels.hpp"

namespace semigeo::repeatability {

/// Tells how many features of one kind, level and radius reappear on a changed mesh. A feature
/// reappears if the changed mesh has one of the same kind and sign within the tolerance. Shares are
/// NaN if there are no features.
struct Repeats {
  std::int64_t features = 0;   ///< Number of features of the original that count.
  std::int64_t found = 0;      ///< Number of features of the kind on the changed mesh.
  double share = 0;            ///< Share of the features that reappear.
  double chance = 0;           ///< Share that would reappear among as many random points.
  double share_prominent = 0;  ///< Share of the more prominent half that reappear.
  double share_twice = 0;      ///< Share that reappear within twice the tolerance.
  double share_scale = 0;      ///< Share that reappear within the scale of the level.
  double median_distance = 0;  ///< Median distance to the nearest such feature, in tolerances.
  double median_miss = 0;      ///< Median distance of those that do not reappear, in tolerances.
};

/// Says how features are compared. Lengths are in the original's units.
struct RepeatOptions {
  double tolerance = 0;  ///< Largest distance at which a feature reappears.
  double area = 0;       ///< Area of the changed surface.
  double scale = 0;      ///< Scale of the original's level.
  /// Returns whether a feature of the original at this position counts.
  std::function<bool(const Eigen::Vector3d&)> counts;
};

/// Compares the features of one kind on two meshes. The cost is a few ns for each pair of features.
Repeats repeats(std::span<const PlacedFeature> original, std::span<const PlacedFeature> changed,
                const RepeatOptions& options);

/// Returns the index of the level whose scale has the ratio to `scale` that is nearest to 1. There
/// must be at least one level.
std::size_t nearest_level(std::span<const ScaleLevel> levels, double scale);

}  // namespace semigeo::repeatability
