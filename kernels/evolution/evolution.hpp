#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "kernels/evolution/curvature.hpp"
#include "kernels/patch/patch.hpp"

namespace semigeo::kernels {

/// The share of the Gaussian's weight below which a vertex is invalid: it has no curvature.
inline constexpr float kMinCompleteness = 0.25f;

/// The area of the convolved tangents, |r_u x r_v|, below which a vertex is invalid because its
/// patch has folded up on itself. The area is 1 on a plane, and 0.37 on a sphere as small as the
/// step.
inline constexpr float kMinTangentArea = 0.1f;

/// Tells which coordinates a patch samples: thesis 4.1.2 or 4.1.3.
enum class Coordinates { kSemigeodesic, kPolar };

/// Tells how the patch of a vertex is laid.
struct PatchLayout {
  float step = 1;  ///< Distance of the samples, in the units of the points.
  Coordinates coordinates = Coordinates::kSemigeodesic;
  std::int32_t first = kNone;  ///< Half-edge from the vertex; kNone stands for `first_edge`.
  bool principal = false;      ///< Whether principal curvatures are wanted.
};

/// Holds what one patch tells of its vertex: the curvature on this level, and the place on the next
/// one.
struct EvolvedVertex {
  Eigen::Vector3f position;         ///< Smoothed place, as the points.
  Eigen::Vector3f smoothed_normal;  ///< Unit normal of the smoothed surface.
  Eigen::Vector3f normal;           ///< Unit normal of the surface of K and H.
  float gaussian_curvature;         ///< In length^-2; 0 if invalid.
  float mean_curvature;             ///< In length^-1; 0 if invalid.
  float patch_completeness;         ///< 1 for a whole patch, 0 if invalid.
  PrincipalCurvatures principal;    ///< All zero if invalid or not wanted.
};

/// Traces the patch of vertex v once and computes everything from it: K and H, the position on the
/// next level, and the normal there. An invalid vertex still moves as far as its samples say, but
/// keeps its normal. All results are finite. Source: thesis 5.3 - 5.6.
///
/// Differs: K and H are those of the surface itself, not of the smoothed
/// one, and come from the full fundamental forms, except for semigeodesic patches on flat faces,
/// which follow the thesis' (4.9) and (4.10).
EvolvedVertex evolve_vertex(const SampledSurface& surface, std::int32_t v,
                            const PatchLayout& layout);

}  // namespace semigeo::kernels
