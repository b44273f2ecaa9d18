#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "kernels/surface/surface.hpp"

namespace semigeo::kernels {

/// What recognition lives on, in the order in which it is stored. Source: thesis 4.5.
enum class FeatureKind {
  gaussian,          ///< a local maximum of |K|
  mean,              ///< of |H|
  gaussian_torsion,  ///< of |torsion| along a contour of K = 0
  mean_torsion       ///< along one of H = 0
};
inline constexpr int kFeatureKinds = 4;
inline constexpr std::array<const char*, kFeatureKinds> kFeatureKindNames = {
    "gaussian", "mean", "gaussian_torsion", "mean_torsion"};

/// Contours are of the kinds gaussian and mean. The maxima of torsion along them are the features
/// of the kind that comes two later.
inline constexpr int kContourKinds = 2;
constexpr int torsion_of(int contour_kind) {
  return contour_kind + kContourKinds;
}

/// One feature of a level. Lengths and curvatures in the scan's length unit.
struct Feature {
  std::int64_t vertex = kNone;  ///< nearest row of the level
  float value = 0;              ///< K, H or torsion, with its sign
  float prominence = 0;         ///< how far |value| falls on the way to a higher one
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< on the level, between its vertices
  Eigen::Vector3f initial_position = Eigen::Vector3f::Zero();  ///< on level 0
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();            ///< unit, of the smoothed surface
  float scale_free_gaussian = 0;  ///< sign(K) sqrt(|K|) sigma; of maxima at the vertex
  float scale_free_mean = 0;      ///< H sigma
};

/// Contours of one kind, K = 0 or H = 0, in equal steps of arc length.
struct SampledContours {
  std::vector<Eigen::Vector3f> points;  ///< (M) all contours, one after the other
  std::vector<float> torsion;           ///< (M) length^-1
  std::vector<std::int64_t> offsets;    ///< (C + 1) first point of each
  std::vector<std::uint8_t> closed;     ///< (C) 1: the last point joins the first
  std::vector<std::int64_t> maxima;     ///< points where |torsion| is a local maximum; each is a
                                        ///< feature, in this order
  double length = 0;                    ///< of all together, before they were cut into steps

  std::int64_t count() const { return static_cast<std::int64_t>(closed.size()); }
};

/// Indexed by FeatureKind.
using FeaturesByKind = std::array<std::vector<Feature>, kFeatureKinds>;

/// All that a level has of these.
struct LevelFeatures {
  FeaturesByKind of_kind;
  std::array<SampledContours, kContourKinds> contours;  ///< of K = 0, of H = 0
};

}  // namespace semigeo::kernels
