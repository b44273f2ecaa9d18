#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "kernels/surface/surface.hpp"

namespace semigeo::kernels {

/// The kinds of features, in the order in which they are stored. Source: thesis 4.5.
enum class FeatureKind {
  kGaussian,         ///< A local maximum of |K|.
  kMean,             ///< A local maximum of |H|.
  kGaussianTorsion,  ///< A local maximum of |torsion| along a contour of K = 0.
  kMeanTorsion       ///< A local maximum of |torsion| along a contour of H = 0.
};
/// The number of kinds of features.
inline constexpr int kFeatureKinds = 4;
/// The names of the kinds of features in files.
inline constexpr std::array<const char*, kFeatureKinds> kFeatureKindNames = {
    "gaussian", "mean", "gaussian_torsion", "mean_torsion"};

/// The number of kinds of contours. They have the first kinds of features: contours of K = 0 and of
/// H = 0.
inline constexpr int kContourKinds = 2;
/// Returns the kind of the features that are maxima of torsion along contours of a kind.
constexpr int torsion_of(int contour_kind) {
  return contour_kind + kContourKinds;
}

/// Describes one feature of a level. Lengths and curvatures are in the scan's length unit.
struct Feature {
  std::int64_t vertex = kNone;  ///< Nearest row of the level.
  float value = 0;              ///< K, H or torsion, with its sign.
  float prominence = 0;         ///< How far |value| falls on the way to a higher one.
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< On the level, between its vertices.
  Eigen::Vector3f initial_position = Eigen::Vector3f::Zero();  ///< On level 0.
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< Unit normal of the smoothed surface.
  float scale_free_gaussian = 0;                     ///< sign(K) sqrt(|K|) sigma at the vertex.
  float scale_free_mean = 0;                         ///< H sigma, at the vertex.
};

/// Holds the contours of one kind, K = 0 or H = 0, in equal steps of arc length.
struct SampledContours {
  std::vector<Eigen::Vector3f> points;  ///< (M) All contours, one after the other.
  std::vector<float> torsion;           ///< (M) In length^-1.
  std::vector<std::int64_t> offsets;    ///< (C + 1) First point of each contour.
  std::vector<std::uint8_t> closed;     ///< (C) 1 where the last point joins the first.
  std::vector<std::int64_t> maxima;     ///< Points where |torsion| is a local maximum; each is a
                                        ///< feature, in this order.
  double length = 0;                    ///< Length of all contours before they were resampled.

  std::int64_t count() const { return static_cast<std::int64_t>(closed.size()); }
};

/// Holds the features of each kind; the index is a FeatureKind.
using FeaturesByKind = std::array<std::vector<Feature>, kFeatureKinds>;

/// Holds all features and contours of a level.
struct LevelFeatures {
  FeaturesByKind of_kind;
  std::array<SampledContours, kContourKinds> contours;  ///< Contours of K = 0, then of H = 0.
};

}  // namespace semigeo::kernels
