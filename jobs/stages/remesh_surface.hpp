#pragma once

#include <cstdint>
#include <span>

#include "engine/run_context.hpp"
#include "jobs/stages/part_measures.hpp"
#include "kernels/repair/remeshing.hpp"

namespace semigeo::jobs {

/// A triangle is odd if a side or a height of it is below so many mean edge lengths (thesis 5.5: "a
/// small fraction").
inline constexpr double kShortestSide = 0.1;

struct RemeshOptions {
  bool curved = true;            ///< new vertices on the curved surface, else on the edges
  double first_edge_length = 0;  ///< mean edge length of level 0
  std::int64_t faces = 0;        ///< refine until there are so many
  std::span<const std::uint8_t> dropped = {};  ///< per part: 1 = too small to carry a patch
};

struct RemeshResult {
  kernels::RemeshCounts counts;
  double shortest_side = 0;        ///< no side and no height is shorter
  std::vector<PartMeasure> parts;  ///< of the result

  bool vanished = false;  ///< only a mark is left
  bool changed() const { return counts != kernels::RemeshCounts{}; }
};

/// Drops parts, removes odd triangles, and refines. Afterwards no side and no height is below
/// kShortestSide times the mean edge length of the mesh, or of level 0 if that is longer: patches
/// are laid with the step of level 0, and do not see what is finer. Refining makes none below twice
/// that. Search over faces runs on all workers, editing is serial; the result does not depend
/// on the number of threads. `parts`: measures of the mesh as it comes.
/// Source: thesis 5.5, 6.1.1.
RemeshResult remesh_surface(kernels::LevelMesh& mesh, std::vector<PartMeasure> parts,
                            const RemeshOptions& options, const engine::RunContext& context);

}  // namespace semigeo::jobs
