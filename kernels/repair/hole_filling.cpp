#include "kernels/repair/hole_filling.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kernels/surface/edge_groups.hpp"

namespace semigeo::kernels {
namespace {

/// The share of the part's area that the vector area of a loop has if it spans the part.
constexpr double kSpanningArea = 0.1;
/// The share of the part's mean radius that the mean radius of a loop has if it spans the part.
constexpr double kSpanningRadius = 0.5;

struct PartSize {
  double area = 0;
  double radius = 0;  ///< Mean distance of the vertices from their centroid.
};

std::vector<PartSize> part_sizes(const Surface& surface) {
  std::vector<PartSize> sizes(surface.part_count);
  std::vector<Eigen::Vector3d> centroid(surface.part_count, Eigen::Vector3d::Zero());
  std::vector<std::int64_t> count(surface.part_count, 0);
  for (std::int64_t v = 0; v < surface.vertex_count(); ++v) {
    centroid[surface.part[v]] += surface.points[v].cast<double>();
    ++count[surface.part[v]];
  }
  for (std::int32_t p = 0; p < surface.part_count; ++p)
    centroid[p] /= static_cast<double>(count[p]);
  for (std::int64_t v = 0; v < surface.vertex_count(); ++v) {
    const std::int32_t p = surface.part[v];
    sizes[p].radius +=
        (surface.points[v].cast<double>() - centroid[p]).norm() / static_cast<double>(count[p]);
  }
  for (const auto& t : surface.triangles) {
    const Eigen::Vector3d a = surface.points[t[0]].cast<double>();
    const Eigen::Vector3d b = surface.points[t[1]].cast<double>();
    const Eigen::Vector3d c = surface.points[t[2]].cast<double>();
    sizes[surface.part[t[0]]].area += 0.5 * (b - a).cross(c - a).norm();
  }
  return sizes;
}

bool spans(const BoundaryLoop& loop, const Surface& surface, const PartSize& part) {
  const auto at = [&](std::size_t k) -> Eigen::Vector3d {
    return surface.points[loop.vertices[k % loop.vertices.size()]].cast<double>();
  };
  const auto n = loop.vertices.size();
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < n; ++k) centroid += at(k) / static_cast<double>(n);
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  double radius = 0;
  for (std::size_t k = 0; k < n; ++k) {
    area += 0.5 * (at(k) - centroid).cross(at(k + 1) - centroid);
    radius += (at(k) - centroid).norm() / static_cast<double>(n);
  }
  return area.norm() >= kSpanningArea * part.area || radius >= kSpanningRadius * part.radius;
}

BoundaryLoop trace_loop(const Surface& surface, std::int32_t first) {
  BoundaryLoop loop;
  loop.part = surface.part[first];
  std::int32_t v = first;
  do {
    loop.vertices.push_back(v);
    const std::int32_t w = surface.target(surface.outgoing[v]);
    loop.length += (surface.points[w] - surface.points[v]).cast<double>().norm();
    v = w;
  } while (v != first);
  // The faces that fill the loop run in the opposite direction.
  std::reverse(loop.vertices.begin() + 1, loop.vertices.end());
  return loop;
}

}  // namespace

std::vector<BoundaryLoop> boundary_loops(const Surface& surface) {
  std::vector<BoundaryLoop> loops;
  std::vector<bool> seen(surface.points.size(), false);
  for (std::int32_t v = 0; v < surface.vertex_count(); ++v) {
    if (seen[v] || !surface.on_boundary(v)) continue;
    loops.push_back(trace_loop(surface, v));
    for (const std::int32_t w : loops.back().vertices) seen[w] = true;
  }
  std::stable_sort(loops.begin(), loops.end(),
                   [](const auto& a, const auto& b) { return a.part < b.part; });
  if (loops.empty()) return loops;
  const std::vector<PartSize> sizes = part_sizes(surface);
  for (std::size_t begin = 0, end = 0; begin < loops.size(); begin = end) {
    while (end < loops.size() && loops[end].part == loops[begin].part) ++end;
    BoundaryLoop& longest =
        *std::max_element(loops.begin() + begin, loops.begin() + end,
                          [](const auto& a, const auto& b) { return a.length < b.length; });
    longest.outer = spans(longest, surface, sizes[longest.part]);
  }
  return loops;
}

bool fillable(const BoundaryLoop& loop, std::int64_t max_edges) {
  return !loop.outer && static_cast<std::int64_t>(loop.vertices.size()) <= max_edges;
}

FilledSurface insert_patches(const Surface& surface, const std::vector<BoundaryLoop>& loops,
                             const std::vector<HolePatch>& patches, std::int64_t max_edges) {
  FilledSurface filled;
  filled.surface = surface;
  Surface& result = filled.surface;
  filled.counts.loops = static_cast<std::int64_t>(loops.size());
  for (std::size_t k = 0; k < loops.size(); ++k) {
    if (!fillable(loops[k], max_edges)) {
      ++(loops[k].outer ? filled.counts.outer : filled.counts.too_long);
      continue;
    }
    ++(patches[k].triangles.empty() ? filled.counts.unsplittable : filled.counts.filled);
    const auto& loop = loops[k].vertices;
    const auto rim = static_cast<std::int32_t>(loop.size());
    const auto first_new = static_cast<std::int32_t>(result.points.size()) - rim;
    result.points.insert(result.points.end(), patches[k].points.begin(), patches[k].points.end());
    for (const auto& t : patches[k].triangles) {
      Triangle face{};
      for (int i = 0; i < 3; ++i) face[i] = t[i] < rim ? loop[t[i]] : first_new + t[i];
      result.triangles.push_back(face);
    }
  }
  filled.vertex_filled.assign(result.points.size(), 0);
  std::fill(filled.vertex_filled.begin() + surface.vertex_count(), filled.vertex_filled.end(), 1);
  filled.face_filled.assign(result.triangles.size(), 0);
  std::fill(filled.face_filled.begin() + surface.face_count(), filled.face_filled.end(), 1);
  if (filled.counts.filled > 0) {
    result.twin =
        pair_twins(group_edges(result.triangles, std::ssize(result.points)), result.face_count());
    connect(result);
  }
  return filled;
}

FilledSurface fill_holes(const Surface& surface, std::int64_t max_edges,
                         const HolePatchOptions& options) {
  const std::vector<BoundaryLoop> loops = boundary_loops(surface);
  std::vector<HolePatch> patches(loops.size());
  for (std::size_t k = 0; k < loops.size(); ++k)
    if (fillable(loops[k], max_edges))
      patches[k] = make_hole_patch(surface, loops[k].vertices, options);
  return insert_patches(surface, loops, patches, max_edges);
}

}  // namespace semigeo::kernels
