#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/recognition/similarity.hpp"
#include "kernels/recognition/triplet.hpp"

namespace semigeo::kernels {

/// Describes two features of one level with their normals, which are enough to fix a similarity.
/// Corner 0 has the lower code.
struct FeaturePair {
  std::uint16_t codes = 0;                    ///< Codes of both corners; they must be the same.
  std::array<std::uint16_t, 2> corners = {};  ///< Indices into OrientedFeatures::features.
  // These numbers are the same after any similarity.
  float log_length = 0;                         ///< log(distance / sigma).
  std::array<float, 4> curvatures = {};         ///< K and H of each corner, scale-free.
  std::array<Eigen::Vector3f, 2> normals = {};  ///< Normals in the frame.
  // These numbers tell where the pair lies.
  Eigen::Matrix3f frame = Eigen::Matrix3f::Zero();  ///< Columns: to corner 1, mean normal, across.
  Eigen::Vector3f middle = Eigen::Vector3f::Zero();
  float length = 0;  ///< Distance of the corners, in length units.
};

/// Says which features are paired.
struct PairOptions {
  int neighbours = 12;   ///< Nearest features within the band that each is paired with.
  double nearest = 1.5;  ///< Least length, in sigma of the level.
  double farthest = 14;  ///< Greatest length, in sigma of the level.
  /// Tells whether a pair of features of one kind is entered both ways, as a scene needs it.
  bool every_order = false;
};

/// Returns the pairs of every feature of a level with its nearest neighbours, each pair once (or
/// once an order), sorted by codes, then corners. Pairs whose normals do not tell how they are
/// turned are left out. Source: thesis 4.5, step 2. Differs: the thesis has groups of three
/// features without normals; here they are groups of two with normals.
std::vector<FeaturePair> local_pairs(const OrientedFeatures& features, const PairOptions& options);

/// Tells whether two pairs of the same codes may be two views of one pair: log lengths within 0.35,
/// curvatures at each corner within 0.25 + 0.35 of their size, normals within 30 degrees in the
/// frames.
bool compatible(const FeaturePair& a, const FeaturePair& b);

/// Holds places in two lists of `local_pairs`.
struct PairMatch {
  std::uint32_t scene = 0;
  std::uint32_t model = 0;
  friend bool operator==(const PairMatch&, const PairMatch&) = default;
};

/// Returns all compatible pairs of the same codes, ascending. The cost is a few ns for each two of
/// the same codes.
std::vector<PairMatch> match_pairs(std::span<const FeaturePair> scene,
                                   std::span<const FeaturePair> model);

/// Returns the similarity that takes `from` to `to`: middle to middle, frame to frame, length to
/// length.
Similarity similarity_between(const FeaturePair& from, const FeaturePair& to);

}  // namespace semigeo::kernels
