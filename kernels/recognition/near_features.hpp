#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/recognition/triplet.hpp"

namespace semigeo::kernels {

/// Which features lie nearest to each of a level's, within a band of distances.
class NearFeatures {
 public:
  /// Looks again, at other features; memory stays. Distances in length units, both included; of
  /// each feature at most `most` are kept. Cost: the square of the features, 0.3 ns each.
  void find(std::span<const OrientedFeature> of_level, double nearest, double farthest, int most);

  /// Places in `of_level`, the nearer first; of equally near ones the earlier.
  std::span<const std::uint16_t> of(std::size_t i) const {
    return std::span(near_).subspan(first_[i], first_[i + 1] - first_[i]);
  }

 private:
  std::array<std::vector<float>, 3> places_;  ///< axis by axis
  std::vector<float> squared_;                ///< distances from the feature at hand
  std::vector<std::uint64_t> in_band_;        ///< squared distance, feature
  std::vector<std::uint16_t> near_;
  std::vector<std::size_t> first_;
};

/// Calls body(features, sigma, place of the first of them) for each level.
template <typename Body>
void for_each_level(const OrientedFeatures& features, const Body& body) {
  const std::vector<OrientedFeature>& all = features.features;
  for (std::size_t first = 0; first < all.size();) {
    std::size_t last = first;
    while (last < all.size() && all[last].level == all[first].level) ++last;
    body(std::span(all).subspan(first, last - first), features.level_scale[all[first].level],
         first);
    first = last;
  }
}

}  // namespace semigeo::kernels
