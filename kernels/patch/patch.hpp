#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

#include "kernels/patch/gaussian.hpp"
#include "kernels/patch/geodesic.hpp"
#include "kernels/patch/patch_samples.hpp"
#include "kernels/surface/quadratic_face.hpp"

namespace semigeo::kernels {

/// Holds the samples of a semigeodesic patch. Column i + kReach has the samples at u = i, from
/// v = -reach_down[column] to v = reach_up[column]; a column whose base sample is missing has reach
/// -1 both ways. Positions are relative to the vertex of the patch, in the units of the points.
struct Patch {
  std::array<std::array<Eigen::Vector4f, kTaps>, kTaps>
      sample;  ///< [column][v + kReach], (x, y, z, 0)
  std::array<std::int8_t, kTaps> reach_up;
  std::array<std::int8_t, kTaps> reach_down;

  /// Tells whether a sample exists.
  bool has(int column, int row) const {
    return row - kReach <= reach_up[column] && kReach - row <= reach_down[column];
  }
  /// Tells whether all samples exist.
  bool whole() const;
  /// Returns the share of the Gaussian's weight that falls on existing samples: 1 for a whole
  /// patch.
  float completeness() const;
  /// Returns the smoothed position of the vertex, relative to it, also for a truncated patch: the
  /// Gaussian mean over pairs of opposite samples that both exist. The rest of the weight stays on
  /// the vertex.
  /// Differs: thesis 5.2 skips such vertices. A mean over all existing samples would pull rims
  /// inwards by a step per pass, and the intercept of a linear fit amplifies waves along curved
  /// rims; this mean leaves planes alone, stays in the convex hull (Theorem 2) and cannot amplify
  /// anything.
  Eigen::Vector3f paired_mean() const;
  /// Returns the existing samples.
  PatchSamples samples() const;
};

/// Describes the surface that patches sample: flat faces, or quadratic ones.
struct SampledSurface {
  GeodesicMesh mesh;
  /// (F + 1) Empty if faces are flat. The last one is spare, because lanes load four numbers where
  /// they need three.
  std::span<const QuadraticFace> curved;
};

/// Returns the position of a point of the sampled surface relative to `centre`. Differences are
/// taken first, since absolute coordinates would cost the digits that curvature needs.
inline Eigen::Vector4f sample_position(const SampledSurface& surface, const FacePoint& at,
                                       const Eigen::Vector4f& centre) {
  const GeodesicMesh& mesh = surface.mesh;
  const std::int32_t h = at.halfedge;
  const Eigen::Vector4f a = mesh.points[mesh.origin(h)];
  const Eigen::Vector4f b = mesh.points[mesh.origin(next(h))];
  const Eigen::Vector4f c = mesh.points[mesh.origin(prev(h))];
  Eigen::Vector4f p = (a - centre) + at.x * (b - a) + at.y * (c - a);
  if (!surface.curved.empty()) {
    const QuadraticFace& face = surface.curved[face_of(h)];
    const float wa = 1 - at.x - at.y;
    p.head<3>() += (wa * at.x) * face.bulge[corner_of(h)] +
                   (at.x * at.y) * face.bulge[corner_of(next(h))] +
                   (at.y * wa) * face.bulge[corner_of(prev(h))];
  }
  return p;
}

/// Returns the half-edge along which the base line of vertex v starts: its outgoing one, or on a
/// boundary the one in the middle of the fan, which leads inwards.
std::int32_t first_edge(const GeodesicMesh& mesh, std::int32_t v);

/// Samples the semigeodesic coordinates of vertex v. The base geodesic runs through v and along
/// `first` (a half-edge that starts at v; u < 0 there), with a sample every `step`; through each of
/// them runs the perpendicular geodesic, both ways. (u, v, outward normal) is right-handed.
/// Half-lines that meet a boundary end there. Source: thesis 5.3, Figure 5.10.
void trace_patch(const SampledSurface& surface, std::int32_t v, std::int32_t first, float step,
                 Patch& patch);

}  // namespace semigeo::kernels
