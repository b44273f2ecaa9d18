#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "bench/repeatability/mesh_changes.hpp"
#include "engine/run_context.hpp"
#include "jobs/stages/evolving_surface.hpp"
#include "kernels/features/features.hpp"
#include "kernels/recognition/similarity.hpp"
#include "kernels/repair/surface_builder.hpp"

namespace semigeo::repeatability {

/// A feature as it is compared: lengths are the original's.
struct PlacedFeature {
  Eigen::Vector3d position;  ///< on level 0
  bool positive = false;     ///< its value
  float prominence = 0;      ///< in the unit of the mesh it was found on
};
using FeaturesByKind = std::array<std::vector<PlacedFeature>, kernels::kFeatureKinds>;

struct ScaleLevel {
  double scale = 0;                       ///< sigma, in the original's units
  std::vector<FeaturesByKind> of_radius;  ///< as `FeatureSearch::radii`
};

struct FeatureSearch {
  std::vector<double> radii = {0, 1, 1.5, 2};  ///< in scales
  bool strong = false;  ///< maxima only where |K| sigma^2 >= 0.01 or |H| sigma >= 0.1
  jobs::EvolutionOptions evolution = {.schedule = jobs::Schedule::kOctaves,
                                      .rescale = jobs::Rescale::kNone};
};

/// Goes on until there are `levels` levels and the scale of the last is at least `last_scale`, but
/// no longer than `max_levels`, or until the surface vanishes. `similarity` is undone.
std::vector<ScaleLevel> scale_levels(const kernels::BuiltSurface& built,
                                     const kernels::Similarity& similarity,
                                     const FeatureSearch& search, int levels, double last_scale,
                                     int max_levels, const engine::RunContext& context);

}  // namespace semigeo::repeatability
