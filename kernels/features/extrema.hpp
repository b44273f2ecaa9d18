#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/surface/circulators.hpp"
#include "kernels/surface/connectivity.hpp"
#include "kernels/surface/geodesic_ball.hpp"

namespace semigeo::kernels {

/// Holds what maxima and contours are searched on: K or H on the vertices of a level, as
/// `heights_of` prepares them.
struct CurvatureField {
  std::span<const float> heights;  ///< (N) 0 where the surface is flat, NaN where none takes part.

  bool takes_part(std::int32_t v) const { return !std::isnan(heights[v]); }
  float magnitude(std::int32_t v) const { return std::abs(heights[v]); }
  /// Tells whether both vertices take part, neither is zero, and they have the same sign.
  bool comparable(std::int32_t v, std::int32_t w) const {
    return (heights[v] > 0 && heights[w] > 0) || (heights[v] < 0 && heights[w] < 0);
  }
  /// Tells whether v is higher than w. The order is strict: where magnitudes are equal, the vertex
  /// with the lower number is the higher one.
  bool higher(std::int32_t v, std::int32_t w) const {
    return magnitude(v) != magnitude(w) ? magnitude(v) > magnitude(w) : v < w;
  }
  /// Tells whether v is comparable with w and higher.
  bool outdoes(std::int32_t v, std::int32_t w) const { return comparable(v, w) && higher(v, w); }
};

/// Returns the heights (N) of vertices with these values of K or H (N), whose patches have this
/// completeness (N). Vertices with less than `min_completeness` take no part; magnitudes up to
/// `flat` count as zero.
std::vector<float> heights_of(std::span<const float> values, std::span<const float> completeness,
                              float min_completeness, float flat);

/// Returns, for each of the fields, the highest of v and its comparable neighbours: the next step
/// of the steepest ascent in |value|. It is v itself at a peak, and kNone if v takes no part or is
/// zero.
template <std::size_t Fields>
std::array<std::int32_t, Fields> uphill(const Connectivity& surface,
                                        const std::array<CurvatureField, Fields>& fields,
                                        std::int32_t v) {
  std::array<std::int32_t, Fields> best;
  best.fill(v);
  for (const std::int32_t w : neighbours(surface, v))
    for (std::size_t i = 0; i < Fields; ++i)
      if (fields[i].outdoes(w, best[i])) best[i] = w;
  for (std::size_t i = 0; i < Fields; ++i)
    if (!fields[i].comparable(v, v)) best[i] = kNone;
  return best;
}

/// Tells whether v is a peak and no comparable vertex within `radius` (units of the points) is
/// higher. The neighbours always count; radius 0 is the rule of the thesis. Source: thesis 5.6.1.
/// Differs: only values of the same sign are compared, so that a ridge beside a deeper valley is a
/// feature, too, and within a radius, so that features do not depend on the triangulation.
bool is_maximum(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
                const CurvatureField& field, std::int32_t v, double radius, GeodesicBall& ball);

/// Tells where a maximum lies: at a point of a face that touches the peak.
struct Summit {
  std::array<std::int32_t, 3> corners = {kNone, kNone, kNone};
  std::array<float, 3> weights = {1, 0, 0};  ///< Barycentric coordinates; their sum is 1.

  /// Interpolates values of all vertices at this point.
  template <typename Values>
  auto of(const Values& values) const {
    using Value = typename Values::value_type;
    return Value(weights[0] * values[corners[0]] + weights[1] * values[corners[1]] +
                 weights[2] * values[corners[2]]);
  }
};

/// Returns where on the faces round the peak v the maximum lies; v is only the nearest sample of
/// it. The place is the centroid of v and its comparable neighbours, weighted by how far they rise
/// above the least of them, moved onto the surface. Differs: the thesis takes the vertex (5.6.1).
/// Another triangulation has other vertices; this point reappears more often (bench/repeatability).
Summit summit(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
              const CurvatureField& field, std::int32_t v);

/// Returns where on the faces round the peak v a quadratic polynomial has its maximum that is
/// fitted to the field on the neighbours of v and on theirs. It is for meshes whose edges are
/// nearly as long as features are wide: there it is nearer to the maximum than `summit`, whose
/// result it is if the fit has no maximum. `values` (N) are K or H, also where they count as zero.
Summit fitted_summit(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
                     const CurvatureField& field, std::span<const float> values, std::int32_t v);

/// Returns for each vertex (N) the peak at which its steepest ascent ends, or kNone. `uphill` holds
/// the results of that function for all vertices (N). The cost is linear.
std::vector<std::int32_t> peaks_of(std::vector<std::int32_t> uphill);

/// Returns the prominence of each vertex (N): how much |value| falls from a peak on the way to a
/// higher one, down to the highest pass between them, among comparable vertices. It is the whole
/// |value| if no higher peak can be reached, and 0 at all vertices that are no peak. `peaks` (N)
/// are the results of `peaks_of`. The cost is that of sorting the passes.
std::vector<float> prominences(const Connectivity& surface, const CurvatureField& field,
                               std::span<const std::int32_t> peaks);

}  // namespace semigeo::kernels
