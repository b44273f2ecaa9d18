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

/// Describes a feature for comparison. Lengths are in the original's units.
struct PlacedFeature {
  Eigen::Vector3d position;  ///< Position on level 0.
  bool positive = false;     ///< Its value is positive.
  float prominence = 0;      ///< Prominence in the units of the mesh on which it was found.
};
/// Holds the features of each kind; the index is a kernels::FeatureKind.
using FeaturesByKind = std::array<std::vector<PlacedFeature>, kernels::kFeatureKinds>;

/// Holds the features of one level.
struct ScaleLevel {
  double scale = 0;                       ///< Sigma, in the original's units.
  std::vector<FeaturesByKind> of_radius;  ///< Features for each of `FeatureSearch::radii`.
};

/// Says how features are found.
struct FeatureSearch {
  std::vector<double> radii = {0, 1, 1.5, 2};  ///< Radii in which maxima are compared, in scales.
  bool strong = false;  ///< Maxima need |K| sigma^2 >= 0.01 or |H| sigma >= 0.1.
  jobs::EvolutionOptions evolution = {.schedule = jobs::Schedule::kOctaves,
                                      .rescale = jobs::Rescale::kNone};
};

/// Evolves a surface and returns the features of its levels. It ends when there are `levels` levels
/// and the scale of the last one is at least `last_scale`, when there are `max_levels` levels, or
/// when the surface vanishes. `similarity` leads from the original to this surface; positions and
/// scales are taken back to the original by it.
std::vector<ScaleLevel> scale_levels(const kernels::BuiltSurface& built,
                                     const kernels::Similarity& similarity,
                                     const FeatureSearch& search, int levels, double last_scale,
                                     int max_levels, const engine::RunContext& context);

}  // namespace semigeo::repeatability
