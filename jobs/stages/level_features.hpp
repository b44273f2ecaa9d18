#pragma once

#include "engine/run_context.hpp"
#include "jobs/stages/evolving_surface.hpp"
#include "kernels/features/features.hpp"

namespace semigeo::jobs {

/// Says which points of a level are features.
struct FeatureOptions {
  /// The radius, along the surface and in scales of the level, within which a maximum of curvature
  /// must be the highest. It must stand out by a thousandth. With 0 the maximum is compared with
  /// its ring of neighbours alone, as in the thesis.
  double radius = 1.5;
  double min_completeness = 0.6;  ///< Least completeness of the patch of a feature's vertex.
};

/// Finds maxima of curvature, zero-crossing contours, their torsion and its maxima on the level
/// that `fields` were evaluated on. Call it before the surface moves on. Maxima come in the order
/// of the level's rows, open contours before closed ones. |K| sigma^2 below 1e-6 and |H| sigma
/// below 1e-5 are zero: what is flat has neither maxima nor contours. Contours run over the curved
/// edges, or over straight ones if the surface is evolved flat: chords have corners, and torsion
/// needs third derivatives. Runs on all workers; the result does not depend on the number of
/// threads. Source: thesis 4.4, 5.6.1, 5.7.
kernels::LevelFeatures find_features(const EvolvingSurface& surface, const LevelFields& fields,
                                     const FeatureOptions& options,
                                     const engine::RunContext& context);

}  // namespace semigeo::jobs
