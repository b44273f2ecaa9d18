#include "kernels/repair/hole_patch.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "kernels/repair/loop_cover.hpp"
#include "kernels/repair/loop_split.hpp"
#include "kernels/repair/plate_fairing.hpp"
#include "kernels/surface/circulators.hpp"
#include "kernels/surface/surface_editor.hpp"

namespace semigeo::kernels {
namespace {

/// The number of rounds in which vertices are inserted. Each round at least halves the area of the
/// faces.
constexpr int kRounds = 24;
/// The number of fairings. A fairing changes the shape, and the next one uses the weights of the
/// new shape.
constexpr int kFairings = 2;
/// The number of rings of faces round the hole that tell how the surface continues.
constexpr int kRings = 4;
/// The length, in edges, of the shortest waves that the patch continues. Shorter waves are noise,
/// which the patch would amplify.
constexpr double kWaveLength = 5;
/// The number of edges of the longest loop that `cover_loop` gets. Its time grows with the third
/// power of that number.
constexpr std::int32_t kLongestCover = 512;

/// Holds a boundary loop of a surface and its points.
struct Rim {
  const Surface& surface;
  std::span<const std::int32_t> loop;  ///< Vertices of the surface.
  std::span<const BoundaryLoop::Join> joins;
  Eigen::Vector3d origin;               ///< The points are relative to it, for precision.
  std::vector<Eigen::Vector3d> points;  ///< One for each vertex of the loop.

  Rim(const Surface& s, const BoundaryLoop& boundary)
      : surface(s),
        loop(boundary.vertices),
        joins(boundary.joins),
        origin(s.points[loop[0]].cast<double>()) {
    for (const std::int32_t v : loop) points.push_back(surface.points[v].cast<double>() - origin);
  }

  std::int32_t size() const { return static_cast<std::int32_t>(loop.size()); }
  /// Tells whether an edge between two places of the loop is impossible: it exists already, also
  /// from another copy of an end, or it would have no length.
  bool joined(std::int32_t a, std::int32_t b) const {
    if (points[a] == points[b] || joined_to(a, loop[b])) return true;
    return std::ranges::any_of(
        joins, [&](const auto& join) { return join.place == b && joined_to(a, join.vertex); });
  }
  /// Tells whether an edge joins any copy of the vertex at a place to another vertex.
  bool joined_to(std::int32_t place, std::int32_t vertex) const {
    if (find_edge(surface, loop[place], vertex) != kNone) return true;
    return std::ranges::any_of(joins, [&](const auto& join) {
      return join.place == place && find_edge(surface, join.vertex, vertex) != kNone;
    });
  }
  bool bounds_single_triangle() const {
    const auto face = [this](std::int32_t k) { return face_of(surface.outgoing[loop[k]]); };
    return size() == 3 && face(0) == face(1) && face(0) == face(2);
  }
};

Eigen::Vector3d face_normal(const std::vector<Eigen::Vector3d>& points, const Triangle& t) {
  return (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]);
}

double area_of(const std::vector<Eigen::Vector3d>& points, std::span<const Triangle> triangles) {
  double area = 0;
  for (const Triangle& t : triangles) area += 0.5 * face_normal(points, t).norm();
  return area;
}

/// Returns the unit normals of the faces on the other side of the loop's edges.
std::vector<Eigen::Vector3d> normals_beyond(const Rim& rim) {
  std::vector<Eigen::Vector3d> normals;
  for (std::int32_t k = 0; k < rim.size(); ++k) {
    // The loop runs against the boundary half-edges.
    const std::int32_t v = rim.loop[k + 1 == rim.size() ? 0 : k + 1];
    const auto& t = rim.surface.triangles[face_of(rim.surface.outgoing[v])];
    const Eigen::Vector3d a = rim.surface.points[t[0]].cast<double>();
    const Eigen::Vector3d b = rim.surface.points[t[1]].cast<double>();
    const Eigen::Vector3d c = rim.surface.points[t[2]].cast<double>();
    normals.push_back((b - a).cross(c - a).normalized());
  }
  return normals;
}

/// Covers a part of the loop that crosses itself seen from any side, and appends the triangles.
/// Returns false if there is no cover.
bool cover_sub_loop(const Rim& rim, const std::vector<std::int32_t>& sub_loop,
                    std::vector<Triangle>& triangles, double& folded_area) {
  const auto n = static_cast<std::int32_t>(sub_loop.size());
  if (n > kLongestCover) return false;
  const std::vector<Eigen::Vector3d> beyond = normals_beyond(rim);
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> normals;
  for (std::int32_t k = 0; k < n; ++k) {
    const std::int32_t v = sub_loop[k];
    points.push_back(rim.points[v]);
    // A splitting line has no known face on its other side.
    const bool on_rim = sub_loop[k + 1 == n ? 0 : k + 1] == (v + 1 == rim.size() ? 0 : v + 1);
    normals.push_back(on_rim ? beyond[v] : Eigen::Vector3d::Zero());
  }
  const LoopCover cover = cover_loop(points, normals, [&](std::int32_t a, std::int32_t b) {
    return rim.joined(sub_loop[a], sub_loop[b]);
  });
  for (const Triangle& t : cover.triangles)
    triangles.push_back({sub_loop[t[0]], sub_loop[t[1]], sub_loop[t[2]]});
  folded_area += cover.folded_area;
  return !cover.triangles.empty();
}

/// Returns triangles between the vertices of the loop that fill it. There are none if no filling is
/// valid.
std::vector<Triangle> triangulate(const Rim& rim) {
  if (rim.bounds_single_triangle()) return {};
  const auto joined = [&](std::int32_t a, std::int32_t b) { return rim.joined(a, b); };
  LoopSplitter splitter;
  const auto split = splitter.split(rim.points, joined);
  if (!split.empty()) return {split.begin(), split.end()};
  std::vector<Triangle> triangles;
  std::vector<std::vector<std::int32_t>> stuck;
  if (rim.size() <= kLongestCover) {
    stuck.resize(1, std::vector<std::int32_t>(rim.size()));
    std::iota(stuck[0].begin(), stuck[0].end(), 0);
  } else {
    const auto most = splitter.split_as_far_as_possible(rim.points, joined, stuck);
    triangles.assign(most.begin(), most.end());
  }
  double folded_area = 0;
  for (const auto& sub_loop : stuck)
    if (!cover_sub_loop(rim, sub_loop, triangles, folded_area)) return {};
  if (!(folded_area <= kMostFolded * area_of(rim.points, triangles))) return {};
  return triangles;
}

/// Holds the patch while it is refined. Vertices 0 ... n - 1 are those of the loop, and later ones
/// are new.
class Patch {
 public:
  Patch(const Rim& rim, std::vector<Triangle> triangles);

  void refine(std::int32_t max_new_vertices);
  void fair();
  HolePatch result() const;

 private:
  struct Surroundings;
  Surroundings surroundings(int rings) const;
  bool is_delaunay(std::int32_t h) const;
  bool flip(std::int32_t h);
  void make_delaunay();
  bool wants_vertex(std::int32_t face) const;
  void insert_at_centroid(std::int32_t face);
  void limit_density(std::int32_t max_new_vertices);

  const Rim& rim_;
  std::vector<Eigen::Vector3d> points_;
  Connectivity mesh_;
  SurfaceEditor editor_;
  std::vector<double> edge_length_;  ///< Wanted edge length at each vertex.
};

Patch::Patch(const Rim& rim, std::vector<Triangle> triangles)
    : rim_(rim),
      points_(rim.points),
      mesh_(connect(std::move(triangles), rim.size())),
      editor_(mesh_) {
  const Surface& surface = rim.surface;
  for (const std::int32_t v : rim.loop) {
    // It is the mean over the edges of the fan.
    double sum = 0;
    int count = 0;
    for (const std::int32_t h : outgoing(surface, v)) {
      sum += (surface.points[surface.target(h)] - surface.points[v]).cast<double>().norm();
      ++count;
    }
    edge_length_.push_back(sum / count);
  }
}

/// Tells whether the angles opposite to an inner edge add up to no more than 180 degrees.
bool Patch::is_delaunay(std::int32_t h) const {
  const auto cot = [&](std::int32_t k) {
    const Eigen::Vector3d& tip = points_[mesh_.origin(prev(k))];
    const Eigen::Vector3d a = points_[mesh_.origin(k)] - tip;
    const Eigen::Vector3d b = points_[mesh_.target(k)] - tip;
    const double sine = a.cross(b).norm();
    const double cosine = a.dot(b);
    return cosine / std::max(sine, 1e-9 * a.norm() * b.norm());
  };
  return cot(h) + cot(mesh_.twin[h]) >= -1e-6;
}

/// Flips an edge to the other diagonal of its two faces, unless the diagonal is an edge already or
/// the patch would fold.
bool Patch::flip(std::int32_t h) {
  const std::int32_t t = mesh_.twin[h];
  const std::int32_t a = mesh_.origin(h);
  const std::int32_t b = mesh_.target(h);
  const std::int32_t c = mesh_.origin(prev(h));
  const std::int32_t d = mesh_.origin(prev(t));
  const Eigen::Vector3d before = face_normal(points_, mesh_.triangles[face_of(h)]) +
                                 face_normal(points_, mesh_.triangles[face_of(t)]);
  if (!(face_normal(points_, {a, d, c}).dot(before) > 0 &&
        face_normal(points_, {d, b, c}).dot(before) > 0))
    return false;
  if (c < rim_.size() && d < rim_.size() && rim_.joined(c, d)) return false;
  if (!editor_.may_flip(h)) return false;
  editor_.flip(h);
  return true;
}

void Patch::make_delaunay() {
  std::vector<std::int32_t> pending;
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(mesh_.face_count()); ++f)
    for (int i = 0; i < 3; ++i)
      if (mesh_.twin[halfedge(f, i)] > halfedge(f, i)) pending.push_back(halfedge(f, i));
  // The number of flips is limited, because on a bent patch they could go on for ever.
  auto budget = 20 * mesh_.face_count();
  while (!pending.empty() && budget > 0) {
    const std::int32_t h = pending.back();
    pending.pop_back();
    if (mesh_.twin[h] == kNone || is_delaunay(h) || !flip(h)) continue;
    --budget;
    const std::int32_t f = face_of(h);
    const std::int32_t g = face_of(mesh_.twin[halfedge(f, 1)]);
    for (const std::int32_t k : {halfedge(f, 0), halfedge(f, 2), halfedge(g, 0), halfedge(g, 1)})
      pending.push_back(k);
  }
}

/// Tells whether the centroid of a face lies farther from its corners than vertices should.
bool Patch::wants_vertex(std::int32_t face) const {
  const Triangle& t = mesh_.triangles[face];
  const Eigen::Vector3d centroid = (points_[t[0]] + points_[t[1]] + points_[t[2]]) / 3;
  const double wanted = (edge_length_[t[0]] + edge_length_[t[1]] + edge_length_[t[2]]) / 3;
  for (const std::int32_t v : t) {
    const double reach = std::numbers::sqrt2 * (points_[v] - centroid).norm();
    if (!(reach > wanted && reach > edge_length_[v])) return false;
  }
  return true;
}

void Patch::insert_at_centroid(std::int32_t face) {
  const auto [a, b, c] = mesh_.triangles[face];
  points_.push_back((points_[a] + points_[b] + points_[c]) / 3);
  edge_length_.push_back((edge_length_[a] + edge_length_[b] + edge_length_[c]) / 3);
  editor_.split_face(face);
}

/// Makes the wanted edges so long that the patch needs at most this number of new vertices.
void Patch::limit_density(std::int32_t max_new_vertices) {
  const double area = area_of(points_, mesh_.triangles);
  // Each vertex takes the area of two equilateral triangles.
  const double shortest = std::sqrt(area / std::max(max_new_vertices, 1) * 2 / std::numbers::sqrt3);
  for (double& length : edge_length_) length = std::max(length, shortest);
}

void Patch::refine(std::int32_t max_new_vertices) {
  make_delaunay();
  limit_density(max_new_vertices);
  for (int round = 0; round < kRounds; ++round) {
    const auto faces = static_cast<std::int32_t>(mesh_.face_count());
    for (std::int32_t f = 0; f < faces; ++f)
      if (wants_vertex(f)) insert_at_centroid(f);
    make_delaunay();
    if (faces == mesh_.face_count()) break;
  }
}

/// Holds the patch with some rings of faces round it.
struct Patch::Surroundings {
  std::vector<Eigen::Vector3d> points;  ///< Points of the patch, then of the faces round it.
  std::vector<PlateRole> roles;
  std::vector<Triangle> triangles;  ///< Triangles round the patch.
  double mean_edge_length = 0;      ///< Mean edge length of those triangles.
};

Patch::Surroundings Patch::surroundings(int rings) const {
  const Surface& surface = rim_.surface;
  Surroundings result;
  result.points = points_;
  result.roles.assign(points_.size(), PlateRole::kFree);
  std::unordered_map<std::int32_t, std::int32_t> index;  // index of each vertex of the surface
  std::unordered_set<std::int32_t> faces;
  for (std::int32_t k = 0; k < rim_.size(); ++k) {
    index.emplace(rim_.loop[k], k);
    result.roles[k] = PlateRole::kTied;
  }
  std::vector<std::int32_t> ring(rim_.loop.begin(), rim_.loop.end());
  for (int depth = 1; depth <= rings; ++depth) {
    std::vector<std::int32_t> next_ring;
    for (const std::int32_t v : ring) {
      for (const std::int32_t h : outgoing(surface, v)) {
        if (!faces.insert(face_of(h)).second) continue;
        Triangle t = surface.triangles[face_of(h)];
        for (std::int32_t& w : t) {
          const auto here = static_cast<std::int32_t>(result.points.size());
          const auto [entry, is_new] = index.emplace(w, here);
          if (is_new) {
            result.points.push_back(surface.points[w].cast<double>() - rim_.origin);
            // Vertices without a closed fan have to be held.
            const bool held = depth == rings || surface.on_boundary(w);
            result.roles.push_back(held ? PlateRole::kHeld : PlateRole::kTied);
            next_ring.push_back(w);
          }
          w = entry->second;
        }
        result.triangles.push_back(t);
      }
    }
    ring = std::move(next_ring);
  }
  for (const Triangle& t : result.triangles)
    for (int i = 0; i < 3; ++i)
      result.mean_edge_length += (result.points[t[i]] - result.points[t[(i + 1) % 3]]).norm() /
                                 (3 * static_cast<double>(result.triangles.size()));
  return result;
}

void Patch::fair() {
  if (points_.size() == rim_.points.size()) return;
  Surroundings around = surroundings(kRings);
  const std::vector<Eigen::Vector3d> targets = around.points;
  for (int k = 0; k < kFairings; ++k) {
    std::vector<Triangle> triangles = mesh_.triangles;
    triangles.insert(triangles.end(), around.triangles.begin(), around.triangles.end());
    if (!fair_plate(around.points, targets, around.roles, triangles,
                    kWaveLength * around.mean_edge_length))
      return;
    std::copy(around.points.begin() + rim_.size(), around.points.begin() + points_.size(),
              points_.begin() + rim_.size());
    make_delaunay();
  }
}

HolePatch Patch::result() const {
  HolePatch patch;
  patch.triangles = mesh_.triangles;
  for (std::size_t k = rim_.points.size(); k < points_.size(); ++k)
    patch.points.push_back((points_[k] + rim_.origin).cast<float>());
  return patch;
}

}  // namespace

HolePatch make_hole_patch(const Surface& surface, const BoundaryLoop& loop,
                          const HolePatchOptions& options) {
  const Rim rim(surface, loop);
  std::vector<Triangle> triangles = triangulate(rim);
  if (triangles.empty() || !options.refine) return {{}, std::move(triangles)};
  Patch patch(rim, std::move(triangles));
  patch.refine(options.max_new_vertices);
  patch.fair();
  return patch.result();
}

}  // namespace semigeo::kernels
