#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "kernels/evolution/curvature.hpp"
#include "kernels/patch/patch.hpp"

namespace semigeo::kernels {

/// Below this share of the Gaussian's weight a vertex is invalid: it has no curvature.
inline constexpr float kMinCompleteness = 0.25f;

/// Area of the convolved tangents r_u x r_v, 1 on a plane, below which a patch has folded up on
/// itself: a sphere as small as the step has 0.37. Such a vertex is invalid too.
inline constexpr float kMinTangentArea = 0.1f;

enum class Coordinates { semigeodesic, polar };

/// How a vertex' patch is laid.
struct PatchLayout {
  float step = 1;                                       ///< sample distance, units of points
  Coordinates coordinates = Coordinates::semigeodesic;  ///< thesis 4.1.2 or 4.1.3
  std::int32_t first = kNone;  ///< half-edge from the vertex; kNone: `first_edge`
  bool principal = false;      ///< principal curvatures as well
};

/// What one patch tells of its vertex: the curvature of this level, and the next level's place.
struct EvolvedVertex {
  Eigen::Vector3f position;         ///< smoothed, same frame and units as the points
  Eigen::Vector3f smoothed_normal;  ///< unit, of the smoothed surface
  Eigen::Vector3f normal;           ///< unit, of the surface that K and H belong to
  float gaussian_curvature;         ///< length^-2, 0 if invalid
  float mean_curvature;             ///< length^-1, 0 if invalid
  float patch_completeness;         ///< 1 = whole patch; 0 = invalid
  PrincipalCurvatures principal;    ///< all zero if invalid or not asked for
};

/// Traces the patch of vertex v once and draws everything from it: K and H, the position on the
/// next level, and the normal there. An invalid vertex still moves as far as its samples say, but
/// keeps its normal. All results are finite.
/// Source: thesis 5.3 - 5.6. Differs: K and H are those of the surface itself, not of the smoothed
/// one, and come from the full fundamental forms, except for semigeodesic patches on flat faces,
/// which follow the thesis' (4.9) and (4.10).
EvolvedVertex evolve_vertex(const SampledSurface& surface, std::int32_t v,
                            const PatchLayout& layout);

}  // namespace semigeo::kernels
