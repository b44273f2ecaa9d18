#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/parallel.hpp"
#include "jobs/stages/evolving_surface.hpp"
#include "tests/support/analytic_surfaces.hpp"

namespace semigeo::accuracy {

/// Where a vertex lies: on a rim (ring 0), one or two edges from it, or inside, which is at least 8
/// edges from a rim. What lies between belongs to no zone. Closed surfaces are all inside.
enum class Zone { inside, ring_0, ring_1, ring_2 };
inline constexpr int kZones = 4;
const char* name_of(Zone zone);

struct ErrorSummary {
  double median = 0;  ///< per cent
  double p95 = 0;     ///< per cent
};

/// Errors of one level of one surface, over the vertices of one zone.
struct ZoneErrors {
  ErrorSummary gaussian, mean;
  std::int64_t used = 0;
  std::int64_t invalid = 0;  ///< the engine gave no curvature
};
using LevelErrors = std::array<ZoneErrors, kZones>;

/// Levels 0 ... `last_level` of a mesh against its truth. Errors are relative to the true K and H;
/// where that is below a tenth of what the other one makes of it, relative to H^2 and sqrt|K|.
std::vector<LevelErrors> analytic_errors(const shapes::AnalyticMesh& mesh, int last_level,
                                         const jobs::EvolutionOptions& options,
                                         engine::Workers& workers);

/// CPU seconds per vertex on one thread, median of `runs`.
struct VertexTime {
  double first_level = 0;  ///< from connectivity to K and H, with the normals' own pass
  double level = 0;        ///< K, H and the next level's position, of a level
};
VertexTime vertex_time(const shapes::AnalyticMesh& mesh, const jobs::EvolutionOptions& options,
                       int runs);

}  // namespace semigeo::accuracy
