#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "engine/run_context.hpp"
#include "jobs/stages/part_measures.hpp"
#include "kernels/repair/remeshing.hpp"

namespace semigeo::jobs {

/// A triangle is odd if one of its sides or heights is below so many mean edge lengths (thesis 5.5:
/// "a small fraction").
inline constexpr double kShortestSide = 0.1;

/// The options of remeshing.
struct RemeshOptions {
  bool curved = true;  ///< New vertices lie on the curved surface; otherwise on the edges.
  double first_edge_length = 0;  ///< Mean edge length of level 0.
  /// Longer edges are outliers, which do not count in the measures of parts.
  double edge_limit = std::numeric_limits<double>::infinity();
  std::int64_t faces = 0;                      ///< The mesh is refined until it has so many faces.
  std::span<const std::uint8_t> dropped = {};  ///< (parts) 1 = too small for a patch.
};

/// What remeshing did.
struct RemeshResult {
  kernels::RemeshCounts counts;
  double shortest_side = 0;        ///< No side and no height is shorter.
  std::vector<PartMeasure> parts;  ///< Measures of the result.
  bool vanished = false;           ///< Only a triangle or a tetrahedron is left.
  bool changed() const { return counts != kernels::RemeshCounts{}; }
};

/// Drops parts, removes odd triangles, and refines. Afterwards no side and no height is below
/// kShortestSide times the mean edge length of the mesh, or of level 0 if that is longer: patches
/// are laid with the step of level 0, and do not resolve anything finer. Refining makes no side and
/// no height below twice that. `parts` are the measures of the mesh as it comes. The search over
/// faces runs on all workers, editing runs on one; the result does not depend on the number of
/// threads. Source: thesis 5.5, 6.1.1.
RemeshResult remesh_surface(kernels::LevelMesh& mesh, std::vector<PartMeasure> parts,
                            const RemeshOptions& options, const engine::RunContext& context);

}  // namespace semigeo::jobs
