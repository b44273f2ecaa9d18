#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/features/features.hpp"

namespace semigeo::kernels {

/// Describes a feature as recognition uses it.
struct OrientedFeature {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< On level 0, in length units.
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();    ///< Unit normal of the smoothed surface.
  float scale_free_gaussian = 0;                       ///< sign(K) sqrt(|K|) sigma.
  float scale_free_mean = 0;                           ///< H sigma.
  float value = 0;        ///< Scale-free value: K sigma^2, H sigma or torsion sigma.
  std::uint8_t code = 0;  ///< See `feature_code`.
  std::uint8_t level = 0;
};

/// The number of feature codes.
inline constexpr int kFeatureCodes = 2 * kFeatureKinds;
/// Returns kind and sign of a feature as one number.
constexpr std::uint8_t feature_code(FeatureKind kind, bool positive) {
  return static_cast<std::uint8_t>(2 * static_cast<int>(kind) + (positive ? 1 : 0));
}

/// Holds features of all levels, level after level, with the scale (sigma) of each level.
struct OrientedFeatures {
  std::vector<OrientedFeature> features;  ///< At most kMostFeatures.
  std::vector<float> level_scale;         ///< In length units.
};
/// The greatest number of features of a model or a scene.
inline constexpr std::size_t kMostFeatures = 65535;

// The cell of a triplet is shape * kCodeTriples + codes; triplets that may match lie in the same
// cell or in one next to it. The shape comes first, so that a range of cells is a range of shapes,
// filled whatever kinds of features there are. Bins are as wide as the difference that may match.
inline constexpr int kSecondRatioBins = 7;  ///< Bins of middle / longest side, from 0.5.
inline constexpr int kThirdRatioBins = 12;  ///< Bins of shortest / longest side, from 0.08.
inline constexpr int kScaleBins = 8;        ///< Bins of log(longest side / sigma), from log 2.
/// The number of shapes.
inline constexpr int kShapes = kSecondRatioBins * kThirdRatioBins * kScaleBins;
/// The number of triples of feature codes.
inline constexpr int kCodeTriples = kFeatureCodes * kFeatureCodes * kFeatureCodes;
/// The number of cells.
inline constexpr int kTripletCells = kShapes * kCodeTriples;

/// The number of invariants of a triplet.
inline constexpr int kInvariants = 16;
/// Holds numbers that no similarity changes, as bytes: two side ratios, log(longest side / sigma),
/// both curvatures of each corner, and the normals of the corners in the frame of the triangle.
/// Each normal has its shares along the normal of the triangle and along the longest side; the
/// signs of the third share, along the height, are in the last byte.
using Invariants = std::array<std::uint8_t, kInvariants>;

/// Describes three features of one level. Corner 0 lies opposite the longest side, corner 2
/// opposite the shortest.
struct Triplet {
  std::uint32_t cell = 0;
  Invariants invariants = {};
  std::array<std::uint16_t, 3> corners = {};  ///< Indices into OrientedFeatures::features.
  friend bool operator==(const Triplet&, const Triplet&) = default;
};

// These tolerances tell how much two views of one feature may differ. The tolerance of scale-free
// curvatures is kCurvatureTolerance plus kCurvatureSlope times their size.
inline constexpr float kScaleTolerance = 0.35F;       ///< Tolerance of log(length / sigma).
inline constexpr float kCurvatureTolerance = 0.25F;   ///< Tolerance of small curvatures.
inline constexpr float kCurvatureSlope = 0.35F;       ///< Tolerance over the size of curvatures.
inline constexpr float kCosNormalTolerance = 0.866F;  ///< Least cosine between normals: 30 degrees.

/// Says which features are joined to triplets.
struct TripletOptions {
  int neighbours = 10;       ///< Nearest features within the band that each is joined with.
  double nearest = 2.5;      ///< Least side, in sigma of the level.
  double farthest = 14;      ///< Greatest side, in sigma of the level.
  double min_height = 0.15;  ///< Least height of the triangle, over its longest side.
  /// Tells whether a triplet with nearly equal sides is entered in every order that the tolerances
  /// allow, as a scene needs it: the order in the model is not known.
  bool every_order = false;
};

/// Returns the local oriented triplets of each level: every feature with pairs of its nearest
/// neighbours. Each triangle comes once (or once an order), sorted by cell, then corners. The cost
/// is the square of the features of a level for the neighbours, and at most 45 triangles a feature.
/// The function is thread-safe. Source: thesis 4.5, step 2. Differs: local instead of all; normals
/// and scale belong to the key.
std::vector<Triplet> local_triplets(const OrientedFeatures& features,
                                    const TripletOptions& options);

/// Returns a cell and the cells of the shapes next to it, with the same codes, ascending. All that
/// may match lies there.
std::vector<std::uint32_t> cells_around(std::uint32_t cell);

/// Tells whether two triplets of neighbouring cells may be two views of one triplet: side
/// ratios within 0.09, log scale within 0.35, curvatures at each corner within 0.25 + 0.35 of their
/// size, normals within 30 degrees under the rotation that the triangles fix.
bool compatible(const Invariants& a, const Invariants& b);

/// Describes a triplet of a library; the index of the library tells its cell.
struct Posting {
  Invariants invariants = {};
  std::uint32_t model = 0;
  std::array<std::uint16_t, 3> corners = {};
  friend bool operator==(const Posting&, const Posting&) = default;
};

/// Appends to `found` the indices of the postings that are compatible, ascending. Bytes are
/// compared 16 at a time, 1 ns a posting; only what passes is examined again.
void find_compatible(const Invariants& wanted, std::span<const Posting> postings,
                     std::vector<std::uint32_t>& found);

}  // namespace semigeo::kernels
