#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/features/features.hpp"

namespace semigeo::kernels {

/// A feature as recognition sees it.
struct OrientedFeature {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< on level 0, in length units
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();    ///< unit, of the smoothed surface
  float scale_free_gaussian = 0;                       ///< sign(K) sqrt(|K|) sigma
  float scale_free_mean = 0;                           ///< H sigma
  float value = 0;  ///< what it is a maximum of, scale-free: K sigma^2, H sigma, torsion sigma
  std::uint8_t code = 0;  ///< feature_code
  std::uint8_t level = 0;
};

/// Kind and sign of a feature in one number.
inline constexpr int kFeatureCodes = 2 * kFeatureKinds;
constexpr std::uint8_t feature_code(FeatureKind kind, bool positive) {
  return static_cast<std::uint8_t>(2 * static_cast<int>(kind) + (positive ? 1 : 0));
}

/// Features of all levels, level after level, with the scale (sigma) of each level.
struct OrientedFeatures {
  std::vector<OrientedFeature> features;  ///< at most kMostFeatures
  std::vector<float> level_scale;         ///< length units
};
inline constexpr std::size_t kMostFeatures = 65535;

/// The cell of a triplet: what must be the same, or next to it. cell = shape * kCodeTriples +
/// codes. Geometry first, so that a range of cells is one of shapes, filled whatever kinds of
/// features there are. Bins are as wide as what may match differs.
inline constexpr int kSecondRatioBins = 7;  ///< of middle / longest side, from 0.5
inline constexpr int kThirdRatioBins = 12;  ///< of shortest / longest side, from 0.08
inline constexpr int kScaleBins = 8;        ///< of log(longest side / sigma), from log 2
inline constexpr int kShapes = kSecondRatioBins * kThirdRatioBins * kScaleBins;
inline constexpr int kCodeTriples = kFeatureCodes * kFeatureCodes * kFeatureCodes;
inline constexpr int kTripletCells = kShapes * kCodeTriples;

/// Numbers that no similarity changes, as bytes: two side ratios, log(longest side / sigma), at
/// each corner both curvatures, and the normals of the corners in the frame of the triangle. Of
/// each normal there are the shares along the triangle's normal and along its longest side; of the
/// third, along the height, the last byte has the signs.
inline constexpr int kInvariants = 16;
using Invariants = std::array<std::uint8_t, kInvariants>;

/// Three features of one level. Corner 0 lies opposite the longest side, corner 2 opposite the
/// shortest.
struct Triplet {
  std::uint32_t cell = 0;
  Invariants invariants = {};
  std::array<std::uint16_t, 3> corners = {};  ///< of OrientedFeatures::features
  friend bool operator==(const Triplet&, const Triplet&) = default;
};

/// How far what is the same feature, seen twice, may differ.
inline constexpr float kScaleTolerance = 0.35F;       ///< of log(length / sigma)
inline constexpr float kCurvatureTolerance = 0.25F;   ///< of scale-free curvatures,
inline constexpr float kCurvatureSlope = 0.35F;       ///< and so much of their size
inline constexpr float kCosNormalTolerance = 0.866F;  ///< between normals: 30 degrees

struct TripletOptions {
  int neighbours = 10;   ///< of each feature, the nearest within the band
  double nearest = 2.5;  ///< band of side lengths, in sigma of the level
  double farthest = 14;
  double min_height = 0.15;  ///< of the triangle, over its longest side
  /// Enter a triplet with nearly equal sides in every order that its tolerances allow, as a scene
  /// must: it does not know which order the model's has.
  bool every_order = false;
};

/// The local oriented triplets of each level: every feature with pairs of its nearest neighbours.
/// Each triangle once (or once an order), sorted by cell, then corners. Cost: the square of a
/// level's features for the neighbours, and 45 triangles a feature at most. Thread-safe.
/// Source: thesis 4.5, step 2. Differs: local instead of all; normals and scale belong to the key.
std::vector<Triplet> local_triplets(const OrientedFeatures& features,
                                    const TripletOptions& options);

/// A cell and the shapes next to it, with the same codes: where all that may match lies. Ascending.
std::vector<std::uint32_t> cells_around(std::uint32_t cell);

/// Whether two triplets of cells next to each other may be the same one, seen twice: side ratios
/// within 0.09, log scale within 0.35, curvatures at each corner within 0.25 + 0.35 of their size,
/// normals within 30 degrees under the rotation that the triangles fix.
bool compatible(const Invariants& a, const Invariants& b);

/// A triplet of a library, whose cell the library's index tells.
struct Posting {
  Invariants invariants = {};
  std::uint32_t model = 0;
  std::array<std::uint16_t, 3> corners = {};
  friend bool operator==(const Posting&, const Posting&) = default;
};

/// Appends to `found` which of the postings are compatible, ascending. Bytes are compared 16 at a
/// time, 1 ns a posting; only what passes is looked at again.
void find_compatible(const Invariants& wanted, std::span<const Posting> postings,
                     std::vector<std::uint32_t>& found);

}  // namespace semigeo::kernels
