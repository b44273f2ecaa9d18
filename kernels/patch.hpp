#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

#include "kernels/gaussian.hpp"
#include "kernels/geodesic.hpp"
#include "kernels/quadratic_face.hpp"

namespace semigeo::kernels {

/// The samples of a semigeodesic patch: column i + kReach holds the samples at u = i, from
/// v = -reach_down[column] to v = reach_up[column]; a column whose base sample is missing has reach
/// -1 both ways. Positions are relative to the patch's vertex, in the units of the points.
struct Patch {
  std::array<std::array<Eigen::Vector4f, kTaps>, kTaps>
      sample;  ///< [column][v + kReach], (x, y, z, 0)
  std::array<std::int8_t, kTaps> reach_up;
  std::array<std::int8_t, kTaps> reach_down;

  bool has(int column, int row) const {
    return row - kReach <= reach_up[column] && kReach - row <= reach_down[column];
  }
  bool whole() const;
  /// Share of the Gaussian's weight that falls on existing samples: 1 for a whole patch.
  float completeness() const;
};

/// The surface that patches sample: flat faces, or quadratic ones.
struct SampledSurface {
  GeodesicMesh mesh;
  std::span<const QuadraticFace> curved;  ///< per face; empty: flat
};

/// The edge along which the base line of vertex v starts: the vertex' first one, or on a boundary
/// the one in the middle of the fan, which leads inwards.
std::int32_t first_edge(const GeodesicMesh& mesh, std::int32_t v);

/// Samples the semigeodesic coordinates of vertex v: the base geodesic through v and along
/// `first` (a half-edge that starts at v, u < 0), its samples every `step`, and through each the
/// perpendicular geodesic both ways. (u, v, outward normal) is right-handed.
/// Half-lines that meet a boundary end there. Source: thesis 5.3, Figure 5.10.
void trace_patch(const SampledSurface& surface, std::int32_t v, std::int32_t first, float step,
                 Patch& patch);

}  // namespace semigeo::kernels
