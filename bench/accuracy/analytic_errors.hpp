#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/parallel.hpp"
#include "jobs/stages/evolving_surface.hpp"
#include "tests/support/analytic_surfaces.hpp"

namespace semigeo::accuracy {

/// The zones in which errors are counted. Vertices that lie in no zone are left out.
enum class Zone {
  kInside,  ///< At least 8 edges from a rim. All vertices of a closed surface lie inside.
  kRing0,   ///< On a rim.
  kRing1,   ///< One edge from a rim.
  kRing2    ///< Two edges from a rim.
};
/// The number of zones.
inline constexpr int kZones = 4;
/// Returns the name of a zone in tables.
const char* name_of(Zone zone);

/// Sums up relative errors.
struct ErrorSummary {
  double median = 0;  ///< In per cent.
  double p95 = 0;     ///< 95th percentile, in per cent.
};

/// Holds the errors of one level of a surface, over the vertices of one zone.
struct ZoneErrors {
  ErrorSummary gaussian;     ///< Errors of K.
  ErrorSummary mean;         ///< Errors of H.
  std::int64_t used = 0;     ///< Number of vertices that have a curvature.
  std::int64_t invalid = 0;  ///< Number of vertices without a curvature.
};
/// Holds the errors of one level; the index is a Zone.
using LevelErrors = std::array<ZoneErrors, kZones>;

/// Compares levels 0 ... `last_level` of a mesh with the true curvature, and returns the errors of
/// each level. Errors are relative to the true K and H. Where |K| is below a tenth of H^2, or |H|
/// below a tenth of sqrt|K|, they are relative to that H^2 or sqrt|K| instead.
std::vector<LevelErrors> analytic_errors(const shapes::AnalyticMesh& mesh, int last_level,
                                         const jobs::EvolutionOptions& options,
                                         engine::Workers& workers);

/// Holds the CPU time for one vertex on one thread, in seconds.
struct VertexTime {
  double first_level = 0;  ///< Time from connectivity to K and H, with the pass over the normals.
  double level = 0;        ///< Time for K, H and the position on the next level.
};
/// Measures the CPU time for one vertex: the median of `runs` runs over the mesh.
VertexTime vertex_time(const shapes::AnalyticMesh& mesh, const jobs::EvolutionOptions& options,
                       int runs);

}  // namespace semigeo::accuracy
