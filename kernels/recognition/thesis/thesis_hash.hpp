#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/features/features.hpp"
#include "kernels/recognition/triplet.hpp"

namespace semigeo::kernels {

// Geometric hashing as the thesis has it (4.5, 5.9), to compare with: all triplets of the strongest
// features of one kind and one level, by two numbers each. Nothing of it is used by
// recognise_scene.

/// The thesis names none of these numbers.
struct ThesisOptions {
  int strongest = 40;        ///< features of each kind, those of the largest |value|
  double min_height = 0.05;  ///< over the longest side; a flatter triangle is collinear
  double address = 1;        ///< tolerance of A
  double indexed = 0.15;     ///< of V
  double length_ratio = 0.05;
  double feature_ratio = 0.1;
};

/// Three features A, B, C of one kind. Corner 0 lies opposite the longest side, corner 2 opposite
/// the shortest; `strongest` is the corner of the largest |value|.
struct ThesisTriplet {
  float address = 0;                        ///< A (4.18)
  float indexed = 0;                        ///< V (4.17)
  std::array<float, 2> length_ratios = {};  ///< middle and shortest side over the longest
  /// Values of the corners that follow the strongest, over its value: signed.
  std::array<float, 2> feature_ratios = {};
  std::uint8_t strongest = 0;
  std::array<std::uint16_t, 3> corners = {};  ///< of OrientedFeatures::features
};

/// The features of a kind and level with the largest |value|, at most so many; the strongest first.
/// Differs: the thesis takes all.
std::vector<std::uint16_t> strongest_features(const OrientedFeatures& features, FeatureKind kind,
                                              int level, int most);

/// All non-collinear triplets of the chosen features, each once. With `every_order` also in the
/// orders in which corners, or which is the strongest, differ by no more than the tolerances: a
/// scene does not know in which order the model has them. Features of value 0 are left out.
/// Source: thesis 4.5.2, steps 2 - 3; all permutations, 5.9.
std::vector<ThesisTriplet> thesis_triplets(const OrientedFeatures& features,
                                           std::span<const std::uint16_t> chosen,
                                           const ThesisOptions& options, bool every_order);

/// Whether V and the four ratios agree. Differs: the thesis only says that individual features are
/// matched as well; here that are the ratios, corner by corner.
inline bool agree(const ThesisTriplet& a, const ThesisTriplet& b, const ThesisOptions& options) {
  const auto near = [](float x, float y, double tolerance) { return std::abs(x - y) <= tolerance; };
  return near(a.indexed, b.indexed, options.indexed) && a.strongest == b.strongest &&
         near(a.length_ratios[0], b.length_ratios[0], options.length_ratio) &&
         near(a.length_ratios[1], b.length_ratios[1], options.length_ratio) &&
         near(a.feature_ratios[0], b.feature_ratios[0], options.feature_ratio) &&
         near(a.feature_ratios[1], b.feature_ratios[1], options.feature_ratio);
}

/// The hash table of one kind of features: triplets of all models, addressed by A in steps of its
/// tolerance.
class ThesisTable {
 public:
  struct Entry {
    ThesisTriplet triplet;
    std::uint32_t model = 0;
  };

  /// Cost: O(n log n).
  ThesisTable(std::vector<Entry> entries, const ThesisOptions& options);

  std::span<const Entry> entries() const { return entries_; }

  /// Calls `visit` with every entry whose A, V and ratios agree, in an order that depends on the
  /// entries only. May be called by several threads at once.
  template <typename Visit>
  void for_matches(const ThesisTriplet& triplet, const Visit& visit) const {
    const std::size_t cell = cell_of(triplet.address);  // and those next to it
    const std::size_t first = first_[cell == 0 ? 0 : cell - 1];
    const std::size_t end = first_[std::min(cell + 2, first_.size() - 1)];
    for (std::size_t i = first; i < end; ++i) {
      const ThesisTriplet& other = entries_[i].triplet;
      const float difference = other.address - triplet.address;
      if (difference > -address_ && difference < address_ && agree(triplet, other, options_))
        visit(entries_[i]);
    }
  }

 private:
  std::size_t cell_of(float address) const;

  ThesisOptions options_;
  float address_ = 0;
  std::vector<Entry> entries_;      ///< by cell
  std::vector<std::size_t> first_;  ///< (cells + 1) of entries_
};

/// m / nC3 x 100: votes per triplet of n features, in per cent; 0 if there are fewer than three.
/// More than 100 where triplets get several votes. Source: thesis 5.9.
double thesis_score(std::int64_t votes, std::int64_t features);

}  // namespace semigeo::kernels
