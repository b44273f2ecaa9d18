#pragma once

#include <utility>
#include <vector>

#include "jobs/stages/evolving_surface.hpp"
#include "kernels/surface_builder.hpp"
#include "kernels/vertex_order.hpp"

namespace semigeo::jobs {

/// The levels of a mesh, as the surface job computes them, in the order of their rows: as long as
/// the connectivity does not change, the mesh's own order of vertices.
struct EvolvedMesh {
  kernels::Surface surface;  ///< as built: connectivity, and points relative to `origin`
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<LevelFields> levels;

  Eigen::Vector3d point(std::size_t level, std::size_t vertex) const {
    return origin + levels[level].points[vertex].cast<double>();
  }
};

template <typename Value>
void put_in_order(std::vector<Value>& values, const std::vector<std::int32_t>& order) {
  if (values.empty()) return;
  std::vector<Value> rows(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) rows[i] = values[order[i]];
  values = std::move(rows);
}

/// Level 0 and `smoothings` more.
inline EvolvedMesh evolve_mesh(kernels::TriangleMesh mesh, int smoothings,
                               const EvolutionOptions& options = {}, int threads = 2) {
  engine::Workers workers(threads);
  engine::Observer observer;
  kernels::BuiltSurface built = kernels::build_surface(std::move(mesh));
  EvolvedMesh result{std::move(built.surface), built.origin, {}};
  const auto order = kernels::locality_order(result.surface);
  EvolvingSurface evolving(kernels::reordered(result.surface, order), options,
                           {workers, observer, {}}, {order, {}, {}});
  for (int k = 0; k <= smoothings; ++k) {
    LevelFields fields = evolving.advance(k < smoothings);
    const std::vector<std::int32_t>& rows = *fields.stored_order;
    put_in_order(fields.points, rows);
    put_in_order(fields.normals, rows);
    put_in_order(fields.gaussian_curvature, rows);
    put_in_order(fields.mean_curvature, rows);
    put_in_order(fields.patch_completeness, rows);
    put_in_order(fields.principal_curvature_1, rows);
    put_in_order(fields.principal_curvature_2, rows);
    put_in_order(fields.principal_direction_1, rows);
    put_in_order(fields.principal_direction_2, rows);
    result.levels.push_back(std::move(fields));
  }
  return result;
}

}  // namespace semigeo::jobs
