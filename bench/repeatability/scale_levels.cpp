#include "bench/repeatability/scale_levels.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bench/support/chance.hpp"
#include "jobs/stages/level_features.hpp"
#include "kernels/surface/vertex_order.hpp"

namespace semigeo::repeatability {
namespace {

using kernels::Feature;
using kernels::FeatureKind;

// The least curvature times scale of a feature that recognition uses.
constexpr float kMinScaleFreeGaussian = 0.1f;  // squared: 0.01
constexpr float kMinScaleFreeMean = 0.1f;

bool strong(FeatureKind kind, const Feature& feature) {
  switch (kind) {
    case FeatureKind::kGaussian:
      return std::abs(feature.scale_free_gaussian) >= kMinScaleFreeGaussian;
    case FeatureKind::kMean:
      return std::abs(feature.scale_free_mean) >= kMinScaleFreeMean;
    case FeatureKind::kGaussianTorsion:
    case FeatureKind::kMeanTorsion:
      break;
  }
  return true;
}

FeaturesByKind placed(const kernels::LevelFeatures& features, const Eigen::Vector3d& origin,
                      const kernels::Similarity& similarity, bool only_strong) {
  FeaturesByKind result;
  for (int kind = 0; kind < kernels::kFeatureKinds; ++kind)
    for (const Feature& feature : features.of_kind[kind])
      if (!only_strong || strong(static_cast<FeatureKind>(kind), feature))
        result[kind].push_back(
            {bench::undo(similarity, feature.initial_position.cast<double>() + origin),
             feature.value > 0, feature.prominence});
  return result;
}

}  // namespace

std::vector<ScaleLevel> scale_levels(const kernels::BuiltSurface& built,
                                     const kernels::Similarity& similarity,
                                     const FeatureSearch& search, int levels, double last_scale,
                                     int max_levels, const engine::RunContext& context) {
  std::vector<std::int32_t> order = kernels::locality_order(built.surface);
  kernels::Surface ordered = kernels::reordered(built.surface, order);
  jobs::EvolvingSurface surface(
      std::move(ordered), search.evolution, context,
      jobs::Origins{.vertex = std::move(order), .vertex_filled = {}, .face_filled = {}});
  std::vector<ScaleLevel> result;
  while (true) {
    const jobs::LevelFields fields = surface.evaluate();
    ScaleLevel& level = result.emplace_back();
    level.scale = fields.scale / similarity.scale;
    for (const double radius : search.radii)
      level.of_radius.push_back(
          placed(jobs::find_features(surface, fields, {.radius = radius}, context), built.origin,
                 similarity, search.strong));
    const int count = static_cast<int>(result.size());
    if (surface.vanished() || count >= max_levels || (count >= levels && level.scale >= last_scale))
      return result;
    surface.move();
  }
}

}  // namespace semigeo::repeatability
