#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/features/extrema.hpp"
#include "kernels/surface/connectivity.hpp"

namespace semigeo::kernels {

/// Describes a point of an edge: (1 - t) of the positive end and t of the negative one.
struct EdgePoint {
  std::int32_t positive = kNone;  ///< The end with a positive value, or zero.
  std::int32_t negative = kNone;
  float t = 0;

  /// Interpolates values of the two ends.
  template <typename Value>
  Value between(const Value& at_positive, const Value& at_negative) const {
    return at_positive + t * (at_negative - at_positive);
  }
};

/// Holds lines along which a field is zero. Seen from outside, positive values lie to their left.
struct Contours {
  std::vector<EdgePoint> points;      ///< All contours, one after the other.
  std::vector<std::int32_t> offsets;  ///< (C + 1) First point of each contour.
  std::vector<std::uint8_t> closed;   ///< (C) 1 where the last point joins the first.

  std::int64_t count() const { return static_cast<std::int64_t>(closed.size()); }
};

/// Appends those faces of [begin, end) through which a contour runs: all corners take part in the
/// field, and their signs differ. Heights of zero count as positive, so
/// that a contour runs through a vertex that is exactly zero, and flat regions have none.
void find_crossing_faces(const Connectivity& surface, const CurvatureField& field,
                         std::int32_t begin, std::int32_t end, std::vector<std::int32_t>& faces);

/// Joins the crossings of faces to contours, open ones first, in the order of the faces. `faces`
/// must be all that `find_crossing_faces` finds, ascending. A crossing lies where linear
/// interpolation along its edge gives zero; points that coincide become one. Contours end at
/// boundaries and at faces that do not take part; contours that shrink to a point are left out. The
/// cost is linear. Source: thesis 5.7.
Contours trace_contours(const Connectivity& surface, const CurvatureField& field,
                        std::span<const std::int32_t> faces);

}  // namespace semigeo::kernels
