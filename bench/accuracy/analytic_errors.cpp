#include "bench/accuracy/analytic_errors.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <stdexcept>

#include "bench/support/quantile.hpp"
#include "kernels/repair/surface_builder.hpp"
#include "kernels/surface/vertex_order.hpp"

namespace semigeo::accuracy {
namespace {

using bench::median;
using bench::quantile;

constexpr int kInside = 8;
/// A curvature below this share of what the other curvature suggests is no scale for errors.
constexpr double kVanishing = 0.1;

/// Holds a surface and the true curvature of its vertices, in the order of the surface.
struct OrderedMesh {
  kernels::Surface surface;
  std::vector<shapes::SurfacePoint> truth;
};

OrderedMesh ordered(const shapes::AnalyticMesh& mesh) {
  kernels::TriangleMesh copy = mesh.mesh;
  const kernels::BuiltSurface built = kernels::build_surface(std::move(copy));
  if (built.repairs != kernels::SurfaceRepairs{} || !built.origin.isZero(0))
    throw std::logic_error("an analytic mesh needs repairs");
  const auto order = kernels::locality_order(built.surface);
  OrderedMesh result{kernels::reordered(built.surface, order), {}};
  for (const std::int32_t old : order) result.truth.push_back(mesh.truth[old]);
  return result;
}

/// Returns the number of edges from each vertex to the nearest rim, at most `kInside`.
std::vector<int> rim_distances(const kernels::Surface& surface) {
  std::vector<int> distance(surface.vertex_count(), kInside);
  for (std::int32_t v = 0; v < surface.vertex_count(); ++v)
    if (surface.on_boundary(v)) distance[v] = 0;
  for (int ring = 1; ring < kInside; ++ring)
    for (const auto& t : surface.triangles)
      for (int i = 0; i < 3; ++i) {
        const std::int32_t a = t[i], b = t[(i + 1) % 3];
        if (distance[a] == ring - 1) distance[b] = std::min(distance[b], ring);
        if (distance[b] == ring - 1) distance[a] = std::min(distance[a], ring);
      }
  return distance;
}

/// Returns the zone of a vertex at this distance from a rim, or -1 if it lies in none.
int zone_of(int distance) {
  if (distance >= kInside) return static_cast<int>(Zone::kInside);
  return distance <= 2 ? static_cast<int>(Zone::kRing0) + distance : -1;
}

double relative_gaussian(double found, const shapes::SurfacePoint& truth) {
  const double other = truth.mean * truth.mean;
  const double own = std::abs(truth.gaussian);
  return std::abs(found - truth.gaussian) / (own < kVanishing * other ? other : own);
}

double relative_mean(double found, const shapes::SurfacePoint& truth) {
  const double other = std::sqrt(std::abs(truth.gaussian));
  const double own = std::abs(truth.mean);
  return std::abs(found - truth.mean) / (own < kVanishing * other ? other : own);
}

LevelErrors errors_of(const jobs::LevelFields& fields,
                      const std::vector<shapes::SurfacePoint>& truth,
                      const std::vector<int>& distance) {
  std::array<std::vector<double>, kZones> gaussian, mean;
  LevelErrors result{};
  for (std::size_t v = 0; v < truth.size(); ++v) {
    const int zone = zone_of(distance[v]);
    if (zone < 0) continue;
    if (fields.patch_completeness[v] == 0) {
      ++result[zone].invalid;
      continue;
    }
    gaussian[zone].push_back(100 * relative_gaussian(fields.gaussian_curvature[v], truth[v]));
    mean[zone].push_back(100 * relative_mean(fields.mean_curvature[v], truth[v]));
  }
  for (int z = 0; z < kZones; ++z) {
    result[z].used = static_cast<std::int64_t>(mean[z].size());
    result[z].gaussian = {median(gaussian[z]), quantile(gaussian[z], 0.95)};
    result[z].mean = {median(mean[z]), quantile(mean[z], 0.95)};
  }
  return result;
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

const char* name_of(Zone zone) {
  constexpr const char* kNames[] = {"inside", "ring 0", "ring 1", "ring 2"};
  return kNames[static_cast<int>(zone)];
}

std::vector<LevelErrors> analytic_errors(const shapes::AnalyticMesh& mesh, int last_level,
                                         const jobs::EvolutionOptions& options,
                                         engine::Workers& workers) {
  const OrderedMesh ready = ordered(mesh);
  const std::vector<int> distance = rim_distances(ready.surface);
  engine::Observer observer;
  jobs::EvolvingSurface evolving(ready.surface, options, {workers, observer, {}});
  std::vector<LevelErrors> levels;
  for (int k = 0; k <= last_level; ++k)
    levels.push_back(errors_of(evolving.advance(k < last_level), ready.truth, distance));
  return levels;
}

VertexTime vertex_time(const shapes::AnalyticMesh& mesh, const jobs::EvolutionOptions& options,
                       int runs) {
  const OrderedMesh ready = ordered(mesh);
  engine::Workers worker(1);
  engine::Observer observer;
  std::vector<double> first, level;
  for (int run = 0; run < runs; ++run) {
    kernels::Surface surface = ready.surface;
    const double start = cpu_seconds();
    jobs::EvolvingSurface evolving(std::move(surface), options, {worker, observer, {}});
    const double prepared = cpu_seconds();
    evolving.advance(false);
    const double end = cpu_seconds();
    first.push_back(end - start);
    level.push_back(end - prepared);
  }
  const auto count = static_cast<double>(ready.truth.size());
  return {median(first) / count, median(level) / count};
}

}  // namespace semigeo::accuracy
