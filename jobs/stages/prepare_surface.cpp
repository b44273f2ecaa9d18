#include "jobs/stages/prepare_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "engine/stopwatch.hpp"
#include "kernels/repair/decimation.hpp"
#include "kernels/surface/circulators.hpp"
#include "kernels/surface/vertex_rows.hpp"

namespace semigeo::jobs {
namespace {

using engine::IndexRange;
using kernels::Surface;

constexpr std::int64_t kPointBlock = 4096;

void fill(PreparedSurface& prepared, std::int64_t max_edges, const engine::RunContext& context) {
  const engine::Stopwatch stopwatch(context.observer, "filling");
  const Surface& surface = prepared.surface;
  const auto loops = kernels::boundary_loops(surface);
  std::vector<kernels::HolePatch> patches(loops.size());
  context.workers.for_blocks(static_cast<std::int64_t>(loops.size()), 1, [&](IndexRange range) {
    for (auto i = range.begin; i < range.end; ++i)
      if (kernels::fillable(loops[i], max_edges))
        patches[i] = kernels::make_hole_patch(surface, loops[i]);
  });
  kernels::FilledSurface filled = kernels::insert_patches(surface, loops, patches, max_edges);
  prepared.surface = std::move(filled.surface);
  prepared.vertex_filled = std::move(filled.vertex_filled);
  prepared.face_filled = std::move(filled.face_filled);
  prepared.result.holes = filled.counts;
}

/// Returns the distance within which a search must look: that of the nearest face around a vertex,
/// with a margin for rounding. The result of the search does not depend on it.
double search_limit(const Surface& surface, std::int32_t vertex, const Eigen::Vector3d& p) {
  double nearest2 = std::numeric_limits<double>::infinity();
  for (const std::int32_t h : kernels::outgoing(surface, vertex)) {
    const auto& t = surface.triangles[kernels::face_of(h)];
    const Eigen::Vector3d q = kernels::nearest_on_triangle(p, surface.points[t[0]].cast<double>(),
                                                           surface.points[t[1]].cast<double>(),
                                                           surface.points[t[2]].cast<double>());
    nearest2 = std::min(nearest2, (p - q).squaredNorm());
  }
  return 1.001 * std::sqrt(nearest2) + 1e-30;
}

/// Measures the distances from all vertices before decimation to the decimated surface, block by
/// block.
kernels::DistanceSummary measure(const kernels::DecimatedSurface& decimated,
                                 std::span<const Eigen::Vector3f> points,
                                 const engine::RunContext& context) {
  const kernels::NearestSurface nearest(decimated.surface);
  const auto count = static_cast<std::int64_t>(points.size());
  std::vector<std::int32_t> kept(points.size(), kernels::kNone);
  for (std::size_t v = 0; v < decimated.source_vertex.size(); ++v)
    kept[decimated.source_vertex[v]] = static_cast<std::int32_t>(v);
  std::vector<kernels::DistanceSummary> blocks((count + kPointBlock - 1) / kPointBlock);
  const auto block_count = static_cast<std::int64_t>(blocks.size());
  context.workers.for_blocks(block_count, 1, [&](IndexRange range) {
    for (auto b = range.begin; b < range.end; ++b)
      for (auto v = b * kPointBlock; v < std::min((b + 1) * kPointBlock, count); ++v) {
        const Eigen::Vector3d p = points[v].cast<double>();
        const double limit = kept[v] == kernels::kNone
                                 ? std::numeric_limits<double>::infinity()
                                 : search_limit(decimated.surface, kept[v], p);
        const double distance = nearest.nearest(p, limit).distance;
        blocks[b].add({.maximum = distance, .sum = distance, .count = 1});
      }
  });
  kernels::DistanceSummary sum;
  for (const auto& block : blocks) sum.add(block);
  return sum;
}

/// Returns the mark of each face of `after`, taken from the nearest face of `before`.
std::vector<std::uint8_t> nearest_marks(const kernels::DecimatedSurface& after,
                                        const Surface& before,
                                        const std::vector<std::uint8_t>& marks,
                                        const engine::RunContext& context) {
  const kernels::NearestSurface nearest(before);
  const Surface& surface = after.surface;
  std::vector<std::uint8_t> result(surface.triangles.size());
  context.workers.for_blocks(surface.face_count(), kPointBlock, [&](IndexRange range) {
    for (auto f = range.begin; f < range.end; ++f) {
      const auto& t = surface.triangles[f];
      Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
      for (const std::int32_t v : t) centroid += surface.points[v].cast<double>() / 3;
      const double limit = search_limit(before, after.source_vertex[t[0]], centroid);
      const std::int32_t face = nearest.nearest(centroid, limit).face;
      result[f] = face == kernels::kNone ? 0 : marks[face];
    }
  });
  return result;
}

void decimate(PreparedSurface& prepared, const PreparationOptions& options,
              const engine::RunContext& context) {
  const engine::Stopwatch stopwatch(context.observer, "decimation");
  PreparationResult& result = prepared.result;
  if (options.decimate > 0)
    result.tolerance =
        options.decimate *
        (options.decimate_in_length_units ? 1 : kernels::mean_edge_length(prepared.surface));
  kernels::DecimatedSurface decimated = kernels::decimate(
      prepared.surface,
      {.tolerance =
           result.tolerance > 0 ? result.tolerance : std::numeric_limits<double>::infinity(),
       .target_vertices = options.target_vertices,
       .measure = false});
  result.removed_vertices = decimated.removed_vertices;
  result.removed_faces = decimated.removed_faces;
  result.distance = measure(decimated, prepared.surface.points, context);
  if (!prepared.vertex_filled.empty()) {
    prepared.face_filled =
        nearest_marks(decimated, prepared.surface, prepared.face_filled, context);
    prepared.vertex_filled = kernels::gathered(prepared.vertex_filled, decimated.source_vertex);
  }
  prepared.surface = std::move(decimated.surface);
}

}  // namespace

nlohmann::json json_of(const PreparationResult& result, const PreparationOptions& options) {
  nlohmann::json json = nlohmann::json::object();
  if (options.fill_holes > 0) {
    json["holes"] = result.holes.loops;
    json["holes_filled"] = result.holes.filled;
    json["holes_left_outer"] = result.holes.outer;
    json["holes_left_too_long"] = result.holes.too_long;
    json["holes_left_unsplittable"] = result.holes.unsplittable;
    json["filled_vertices"] = result.filled_vertices;
    json["filled_faces"] = result.filled_faces;
  }
  if (options.decimates()) {
    json["removed_vertices"] = result.removed_vertices;
    json["removed_faces"] = result.removed_faces;
    json["decimation_tolerance"] = result.tolerance;
    json["decimation_distance_maximum"] = result.distance.maximum;
    json["decimation_distance_mean"] = result.distance.mean();
  }
  return json;
}

PreparedSurface prepare_surface(Surface surface, const PreparationOptions& options,
                                const engine::RunContext& context) {
  PreparedSurface prepared{std::move(surface), {}, {}, {}};
  if (options.fill_holes > 0) fill(prepared, options.fill_holes, context);
  if (options.decimates()) decimate(prepared, options, context);
  prepared.result.filled_vertices = std::ranges::count(prepared.vertex_filled, 1);
  prepared.result.filled_faces = std::ranges::count(prepared.face_filled, 1);
  return prepared;
}

}  // namespace semigeo::jobs
