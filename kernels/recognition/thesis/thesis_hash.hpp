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

// Geometric hashing as in the thesis (4.5, 5.9), for comparison. All triplets of the strongest
// features of one kind and one level are hashed by two numbers. recognise_scene uses none of it.

/// Holds numbers that the thesis does not name.
struct ThesisOptions {
  int strongest = 40;          ///< Features of each kind, those of the largest |value|.
  double min_height = 0.05;    ///< Over the longest side; flatter triangles are collinear.
  double address = 1;          ///< Tolerance of A.
  double indexed = 0.15;       ///< Tolerance of V.
  double length_ratio = 0.05;  ///< Tolerance of ratios of sides.
  double feature_ratio = 0.1;  ///< Tolerance of ratios of values.
};

/// Describes three features A, B, C of one kind. Corner 0 lies opposite the longest side, corner 2
/// opposite the shortest; `strongest` is the corner of the largest |value|.
struct ThesisTriplet {
  float address = 0;                        ///< A (4.18).
  float indexed = 0;                        ///< V (4.17).
  std::array<float, 2> length_ratios = {};  ///< Middle and shortest side over the longest.
  /// The values of the two corners that follow the strongest, over its value, with their signs.
  std::array<float, 2> feature_ratios = {};
  std::uint8_t strongest = 0;
  std::array<std::uint16_t, 3> corners = {};  ///< Indices into OrientedFeatures::features.
};

/// Returns the features of a kind and level with the largest |value|, at most `most`, the strongest
/// first. Differs: the thesis takes all.
std::vector<std::uint16_t> strongest_features(const OrientedFeatures& features, FeatureKind kind,
                                              int level, int most);

/// Returns all triplets of the chosen features that are not collinear, each once. With
/// `every_order` a triplet also comes in every order in which sides, or the strongest values,
/// differ by no more than the tolerances, since the order in the model is not known. Features of
/// value 0 are left out. Source: thesis 4.5.2, steps 2 - 3; all permutations, 5.9.
std::vector<ThesisTriplet> thesis_triplets(const OrientedFeatures& features,
                                           std::span<const std::uint16_t> chosen,
                                           const ThesisOptions& options, bool every_order);

/// Tells whether V and the four ratios of two triplets agree. Differs: the thesis only says that
/// individual features are matched as well; here these are the ratios, corner by corner.
inline bool agree(const ThesisTriplet& a, const ThesisTriplet& b, const ThesisOptions& options) {
  const auto near = [](float x, float y, double tolerance) { return std::abs(x - y) <= tolerance; };
  return near(a.indexed, b.indexed, options.indexed) && a.strongest == b.strongest &&
         near(a.length_ratios[0], b.length_ratios[0], options.length_ratio) &&
         near(a.length_ratios[1], b.length_ratios[1], options.length_ratio) &&
         near(a.feature_ratios[0], b.feature_ratios[0], options.feature_ratio) &&
         near(a.feature_ratios[1], b.feature_ratios[1], options.feature_ratio);
}

/// Holds the hash table of one kind of features: triplets of all models, addressed by A in steps of
/// its tolerance.
class ThesisTable {
 public:
  /// A triplet and its model.
  struct Entry {
    ThesisTriplet triplet;
    std::uint32_t model = 0;
  };

  /// Sorts the entries; the cost is O(n log n).
  ThesisTable(std::vector<Entry> entries, const ThesisOptions& options);

  std::span<const Entry> entries() const { return entries_; }

  /// Calls `visit` with every entry whose A, V and ratios agree, in an order that depends on the
  /// entries only. Several threads may call it at once.
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
  std::vector<Entry> entries_;      ///< Sorted by cell.
  std::vector<std::size_t> first_;  ///< (cells + 1) First entry of each cell.
};

/// Returns m / nC3 x 100: the votes per triplet of n features, in per cent, or 0 if there are fewer
/// than three features. It is more than 100 where triplets get several votes. Source: thesis 5.9.
double thesis_score(std::int64_t votes, std::int64_t features);

}  // namespace semigeo::kernels
