#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/recognition/similarity.hpp"
#include "kernels/recognition/triplet.hpp"

namespace semigeo::kernels {

/// Two features of one level with their normals: with no third one, all that fixes a similarity.
/// Corner 0 has the lower code.
struct FeaturePair {
  std::uint16_t codes = 0;                    ///< of both corners; what must be the same
  std::array<std::uint16_t, 2> corners = {};  ///< of OrientedFeatures::features
  // Numbers that no similarity changes.
  float log_length = 0;                         ///< log(distance / sigma)
  std::array<float, 4> curvatures = {};         ///< K and H of each corner, scale-free
  std::array<Eigen::Vector3f, 2> normals = {};  ///< in the frame
  // Where it lies.
  Eigen::Matrix3f frame = Eigen::Matrix3f::Zero();  ///< columns: to corner 1, mean normal, across
  Eigen::Vector3f middle = Eigen::Vector3f::Zero();
  float length = 0;  ///< length units
};

struct PairOptions {
  int neighbours = 12;   ///< of each feature, the nearest within the band
  double nearest = 1.5;  ///< band of lengths, in sigma of the level
  double farthest = 14;
  /// Enter a pair of features of one kind both ways, as a scene must.
  bool every_order = false;
};

/// Every feature of a level with its nearest neighbours, each pair once (or once an order); by
/// codes, then corners. Pairs whose normals do not tell how they are turned are left out.
/// Source: thesis 4.5, step 2. Differs: two oriented features where the thesis has three.
std::vector<FeaturePair> local_pairs(const OrientedFeatures& features, const PairOptions& options);

/// Whether two pairs of the same codes may be the same one, seen twice: log length within 0.35,
/// curvatures at each corner within 0.25 + 0.35 of their size, normals within 30 degrees in the
/// frames.
bool compatible(const FeaturePair& a, const FeaturePair& b);

/// Places in two lists of local_pairs.
struct PairMatch {
  std::uint32_t scene = 0;
  std::uint32_t model = 0;
  friend bool operator==(const PairMatch&, const PairMatch&) = default;
};

/// All compatible pairs of the same codes, ascending. Cost: a few ns for each two of the same
/// codes.
std::vector<PairMatch> match_pairs(std::span<const FeaturePair> scene,
                                   std::span<const FeaturePair> model);

/// The similarity that takes `from` to `to`: middle to middle, frame to frame, length to length.
Similarity similarity_between(const FeaturePair& from, const FeaturePair& to);

}  // namespace semigeo::kernels
