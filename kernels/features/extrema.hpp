#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/surface/connectivity.hpp"
#include "kernels/surface/geodesic_ball.hpp"

namespace semigeo::kernels {

/// K or H on the vertices of a level.
struct CurvatureField {
  std::span<const float> values;        ///< (N)
  std::span<const float> completeness;  ///< (N) of the patches
  float min_completeness = 0.6f;        ///< vertices with less take no part
  float flat = 0;                       ///< what is smaller counts as zero

  bool counts(std::int32_t v) const { return completeness[v] >= min_completeness; }
  float magnitude(std::int32_t v) const { return std::abs(values[v]); }
  /// Both take part, neither is zero, and they bend the same way.
  bool comparable(std::int32_t v, std::int32_t w) const {
    return counts(v) && counts(w) && magnitude(v) > flat && magnitude(w) > flat &&
           (values[v] > 0) == (values[w] > 0);
  }
  /// A strict order: of equal magnitudes the vertex with the lower number is the higher.
  bool higher(std::int32_t v, std::int32_t w) const {
    return magnitude(v) != magnitude(w) ? magnitude(v) > magnitude(w) : v < w;
  }
};

/// The highest of v and its comparable neighbours: the next step of the steepest ascent in
/// |value|. v itself at a peak; kNone if v takes no part or is zero.
std::int32_t uphill(const Connectivity& surface, const CurvatureField& field, std::int32_t v);

/// Whether no comparable vertex within `radius` (units of the points) of the peak v is higher. The
/// ring of neighbours always counts; radius 0 is the thesis' rule.
/// Source: thesis 5.6.1. Differs: compares only values of the same sign, so that a ridge beside a
/// deeper valley is a feature too, and within a radius, so that features do not depend on the
/// triangulation.
bool is_maximum(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
                const CurvatureField& field, std::int32_t v, double radius, GeodesicBall& ball);

/// Where a maximum lies: a point of a face at the peak.
struct Summit {
  std::array<std::int32_t, 3> corners = {kNone, kNone, kNone};
  std::array<float, 3> weights = {1, 0, 0};  ///< sum to 1

  /// Of values at all vertices, the one here.
  template <typename Values>
  auto of(const Values& values) const {
    using Value = typename Values::value_type;
    return Value(weights[0] * values[corners[0]] + weights[1] * values[corners[1]] +
                 weights[2] * values[corners[2]]);
  }
};

/// Where on the faces round the peak v the maximum lies, of which v is but the nearest sample: at
/// the centroid of v and its comparable neighbours, weighted by how far they rise above the least
/// of them, moved onto the surface.
/// Differs: the thesis takes the vertex (5.6.1). Another triangulation has other vertices; this
/// point reappears more often (bench/repeatability).
Summit summit(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
              const CurvatureField& field, std::int32_t v);

/// For each vertex the peak at which its steepest ascent ends, or kNone. `uphill`: (N) results of
/// that function; is used up. Linear cost.
std::vector<std::int32_t> peaks_of(std::vector<std::int32_t> uphill);

/// How much |value| falls from each peak on the way to the nearest higher one: to the highest pass
/// between them, among comparable vertices; all of it if no higher one can be reached. result: (N),
/// 0 at all vertices that are no peak. `peaks`: of each vertex.
std::vector<float> prominences(const Connectivity& surface, const CurvatureField& field,
                               std::span<const std::int32_t> peaks);

}  // namespace semigeo::kernels
