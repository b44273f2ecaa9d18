#pragma once

#include <tuple>
#include <utility>
#include <vector>

#include "jobs/stages/evolving_surface.hpp"
#include "jobs/stages/level_features.hpp"
#include "kernels/repair/surface_builder.hpp"
#include "kernels/surface/vertex_order.hpp"
#include "kernels/surface/vertex_rows.hpp"

namespace semigeo::jobs {

/// The levels of a mesh, as the surface job computes them, in the order of their rows: as long as
/// the connectivity does not change, the mesh's own order of vertices.
struct EvolvedMesh {
  kernels::Surface surface;  ///< as built: connectivity, and points relative to `origin`
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<LevelFields> levels;
  std::vector<kernels::LevelFeatures> features;

  Eigen::Vector3d point(std::size_t level, std::size_t vertex) const {
    return origin + levels[level].points[vertex].cast<double>();
  }
};

/// Level 0 and `smoothings` more.
inline EvolvedMesh evolve_mesh(kernels::TriangleMesh mesh, int smoothings,
                               const EvolutionOptions& options = {}, int threads = 2,
                               const FeatureOptions& feature_options = {}) {
  engine::Workers workers(threads);
  engine::Observer observer;
  kernels::BuiltSurface built = kernels::build_surface(std::move(mesh));
  EvolvedMesh result{std::move(built.surface), built.origin, {}, {}};
  const auto order = kernels::locality_order(result.surface);
  const engine::RunContext context{workers, observer, {}};
  EvolvingSurface evolving(kernels::reordered(result.surface, order), options, context,
                           {order, {}, {}});
  for (int k = 0; k <= smoothings; ++k) {
    LevelFields fields = evolving.evaluate();
    result.features.push_back(find_features(evolving, fields, feature_options, context));
    if (k < smoothings) evolving.move();
    const std::vector<std::int32_t>& rows = *fields.stored_order;
    kernels::gather_rows(std::tie(fields.points, fields.normals, fields.gaussian_curvature,
                                  fields.mean_curvature, fields.patch_completeness,
                                  fields.principal_curvature_1, fields.principal_curvature_2,
                                  fields.principal_direction_1, fields.principal_direction_2),
                         rows);
    result.levels.push_back(std::move(fields));
  }
  return result;
}

}  // namespace semigeo::jobs
