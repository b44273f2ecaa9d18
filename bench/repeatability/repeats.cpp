#include "bench/repeatability/repeats.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bench/support/quantile.hpp"

namespace semigeo::repeatability {
namespace {

struct Found {
  double distance;  ///< Distance to the nearest feature of the same sign.
  float prominence;
};

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double share_within(std::span<const Found> found, double distance) {
  if (found.empty()) return kNaN;
  const auto near =
      std::ranges::count_if(found, [distance](const Found& f) { return f.distance <= distance; });
  return static_cast<double>(near) / static_cast<double>(found.size());
}

double nearest_distance(const PlacedFeature& feature, std::span<const PlacedFeature> others) {
  double nearest2 = std::numeric_limits<double>::infinity();
  for (const PlacedFeature& other : others)
    if (other.positive == feature.positive)
      nearest2 = std::min(nearest2, (other.position - feature.position).squaredNorm());
  return std::sqrt(nearest2);
}

/// Returns the probability that one of `points` random points lies within the tolerance of a
/// feature.
double chance_of(std::int64_t points, const RepeatOptions& options) {
  const double disc = std::numbers::pi * options.tolerance * options.tolerance;
  return 1 - std::pow(1 - std::min(1.0, disc / options.area), static_cast<double>(points));
}

/// Returns the more prominent half, or the only one.
std::vector<Found> prominent_half(std::vector<Found> found) {
  const auto middle = found.begin() + static_cast<std::ptrdiff_t>(found.size() / 2);
  std::nth_element(found.begin(), middle, found.end(),
                   [](const Found& a, const Found& b) { return a.prominence > b.prominence; });
  found.erase(found.size() > 1 ? middle : found.end(), found.end());
  return found;
}

}  // namespace

Repeats repeats(std::span<const PlacedFeature> original, std::span<const PlacedFeature> changed,
                const RepeatOptions& options) {
  std::vector<Found> found;
  const std::int64_t positive = std::ranges::count_if(changed, &PlacedFeature::positive);
  const std::int64_t negative = std::ssize(changed) - positive;
  double chance = 0;
  for (const PlacedFeature& feature : original) {
    if (!options.counts(feature.position)) continue;
    found.push_back({nearest_distance(feature, changed), feature.prominence});
    chance += chance_of(feature.positive ? positive : negative, options);
  }
  std::vector<double> distances, misses;
  for (const Found& f : found) {
    distances.push_back(f.distance / options.tolerance);
    if (distances.back() > 1) misses.push_back(distances.back());
  }
  return {.features = std::ssize(found),
          .found = std::ssize(changed),
          .share = share_within(found, options.tolerance),
          .chance = found.empty() ? kNaN : chance / static_cast<double>(found.size()),
          .share_prominent = share_within(prominent_half(found), options.tolerance),
          .share_twice = share_within(found, 2 * options.tolerance),
          .share_scale = share_within(found, options.scale),
          .median_distance = bench::median(distances),
          .median_miss = bench::median(misses)};
}

std::size_t nearest_level(std::span<const ScaleLevel> levels, double scale) {
  const auto nearest = std::ranges::min_element(levels, {}, [scale](const ScaleLevel& level) {
    return std::abs(std::log(level.scale / scale));
  });
  return static_cast<std::size_t>(nearest - levels.begin());
}

}  // namespace semigeo::repeatability
