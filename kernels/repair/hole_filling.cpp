#include "kernels/repair/hole_filling.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <span>
#include <utility>

#include "kernels/surface/circulators.hpp"
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
    v = surface.target(surface.outgoing[v]);
  } while (v != first);
  // The faces that fill the loop run in the opposite direction.
  std::reverse(loop.vertices.begin() + 1, loop.vertices.end());
  return loop;
}

/// Tells whether two vertices may become one. No edge from one may lie on an edge from the other.
bool may_join(const Surface& surface, std::int32_t a, std::int32_t b) {
  for (const std::int32_t h : neighbours(surface, a))
    for (const std::int32_t k : neighbours(surface, b))
      if (surface.points[h] == surface.points[k]) return false;
  return true;
}

/// Takes a loop apart where it passes a point again, and appends what it consists of.
class LoopAtTouchingPoints {
 public:
  LoopAtTouchingPoints(const Surface& surface, std::vector<BoundaryLoop>& loops)
      : surface_(surface), loops_(loops) {}

  void take_apart(const BoundaryLoop& loop) {
    part_ = loop.part;
    for (const std::int32_t v : loop.vertices) {
      const auto seen = last_.find(key(v));
      if (seen == last_.end() || !may_join_all(path_[seen->second], v)) {
        last_[key(v)] = path_.size();
        path_.push_back({v});
        continue;
      }
      const std::size_t touching = seen->second;
      append(touching + 1, v, path_[touching].back());
      path_[touching].push_back(v);
    }
    append(0, kNone, kNone);
  }

 private:
  using Key = std::array<float, 3>;
  /// The copies of a vertex, in the order in which the loop leaves it: it arrives at the first.
  using Copies = std::vector<std::int32_t>;

  Key key(std::int32_t v) const {
    const auto& p = surface_.points[v];
    return {p.x(), p.y(), p.z()};
  }

  bool may_join_all(const Copies& copies, std::int32_t v) const {
    return std::ranges::all_of(copies,
                               [&](std::int32_t copy) { return may_join(surface_, copy, v); });
  }

  /// Moves the end of the path, from place `first` on, into a loop that closes at vertex `close`,
  /// from where the copy `departs` goes on.
  void append(std::size_t first, std::int32_t close, std::int32_t departs) {
    BoundaryLoop loop;
    loop.part = part_;
    for (std::size_t k = first; k < path_.size(); ++k) {
      last_.erase(key(path_[k].front()));
      add(loop, path_[k].front(), path_[k].back());
    }
    path_.resize(first);
    if (close != kNone) add(loop, close, departs);
    const auto n = loop.vertices.size();
    for (std::size_t k = 0; k < n; ++k)
      loop.length +=
          (surface_.points[loop.vertices[(k + 1) % n]] - surface_.points[loop.vertices[k]])
              .cast<double>()
              .norm();
    loops_.push_back(std::move(loop));
  }

  static void add(BoundaryLoop& loop, std::int32_t arrives, std::int32_t departs) {
    if (departs != arrives)
      loop.joins.push_back({static_cast<std::int32_t>(loop.vertices.size()), departs});
    loop.vertices.push_back(arrives);
  }

  const Surface& surface_;
  std::vector<BoundaryLoop>& loops_;
  std::int32_t part_ = 0;
  std::vector<Copies> path_;
  std::map<Key, std::size_t> last_;  ///< The last place of each point in the path.
};

/// Makes one vertex, the lowest, of copies that patches have joined. The others keep their order.
void join_copies(std::span<const std::array<std::int32_t, 2>> joins, FilledSurface& filled) {
  Surface& surface = filled.surface;
  std::vector<std::int32_t> lowest(surface.points.size());
  std::iota(lowest.begin(), lowest.end(), 0);
  const auto lowest_of = [&](std::int32_t v) {
    while (lowest[v] != v) v = lowest[v] = lowest[lowest[v]];
    return v;
  };
  for (const auto& [a, b] : joins) {
    const auto [low, high] = std::minmax({lowest_of(a), lowest_of(b)});
    lowest[high] = low;
  }
  std::vector<std::int32_t> number(surface.points.size());
  std::size_t count = 0;
  for (std::int32_t v = 0; v < std::ssize(number); ++v) {
    if (lowest_of(v) != v) continue;
    number[v] = static_cast<std::int32_t>(count);
    surface.points[count] = surface.points[v];
    filled.vertex_filled[count] = filled.vertex_filled[v];
    ++count;
  }
  surface.points.resize(count);
  filled.vertex_filled.resize(count);
  for (Triangle& t : surface.triangles)
    for (std::int32_t& v : t) v = number[lowest_of(v)];
}

}  // namespace

std::vector<BoundaryLoop> boundary_loops(const Surface& surface) {
  std::vector<BoundaryLoop> loops;
  std::vector<bool> seen(surface.points.size(), false);
  for (std::int32_t v = 0; v < surface.vertex_count(); ++v) {
    if (seen[v] || !surface.on_boundary(v)) continue;
    BoundaryLoop loop = trace_loop(surface, v);
    for (const std::int32_t w : loop.vertices) seen[w] = true;
    LoopAtTouchingPoints(surface, loops).take_apart(loop);
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
  filled.counts.loops = std::ssize(loops);
  std::vector<std::array<std::int32_t, 2>> joins;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    if (!fillable(loops[k], max_edges)) {
      ++(loops[k].outer ? filled.counts.outer : filled.counts.too_long);
      continue;
    }
    if (patches[k].triangles.empty()) {
      ++filled.counts.unsplittable;
      continue;
    }
    ++filled.counts.filled;
    const auto& loop = loops[k].vertices;
    for (const BoundaryLoop::Join& join : loops[k].joins)
      joins.push_back({loop[join.place], join.vertex});
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
    if (!joins.empty()) join_copies(joins, filled);
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
    if (fillable(loops[k], max_edges)) patches[k] = make_hole_patch(surface, loops[k], options);
  return insert_patches(surface, loops, patches, max_edges);
}

}  // namespace semigeo::kernels
