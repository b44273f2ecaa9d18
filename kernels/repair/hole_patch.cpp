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
#include "kernels/surface/edge_groups.hpp"

namespace semigeo::kernels {
namespace {

using Triangle = std::array<std::int32_t, 3>;

/// Rounds of inserting vertices; each halves the area of the faces at least.
constexpr int kRounds = 24;
/// Fairing changes the shape, and with it the weights that it was computed with.
constexpr int kFairings = 2;
/// Rings of faces round the hole that tell how the surface continues ...
constexpr int kRings = 4;
/// ... in waves of so many edges and more; shorter ones would be noise that the patch amplifies.
constexpr double kWaveLength = 5;
/// Edges of the longest loop for `cover_loop`, whose time grows with the third power.
constexpr std::int32_t kLongestCover = 512;

bool joined_in(const Surface& surface, std::int32_t a, std::int32_t b) {
  std::int32_t h = surface.outgoing[a];
  const std::int32_t start = h;
  do {
    if (surface.target(h) == b || surface.origin(prev(h)) == b) return true;
    h = surface.ccw(h);
  } while (h != kNone && h != start);
  return false;
}

/// The patch while it is made: vertices 0 ... n - 1 are the loop, vertices that come later are new.
class Patch {
 public:
  Patch(const Surface& surface, std::span<const std::int32_t> loop);

  bool split_loop();
  bool cover_sub_loop(const std::vector<std::int32_t>& sub_loop, double& folded_area);
  void refine(std::int32_t max_new_vertices);
  void fair();
  HolePatch result() const;

 private:
  struct Surroundings;
  Surroundings surroundings(int rings) const;
  std::int32_t origin(std::int32_t h) const { return triangles_[face_of(h)][corner_of(h)]; }
  std::vector<Eigen::Vector3d> rim_normals() const;
  Eigen::Vector3d face_normal(const Triangle& t) const;
  bool joined(std::int32_t a, std::int32_t b) const;
  bool delaunay(std::int32_t h) const;
  bool flip(std::int32_t h);
  void make_delaunay();
  void link(std::int32_t h, std::int32_t twin);
  bool wants_vertex(std::int32_t face) const;
  void insert_at_centroid(std::int32_t face);
  void limit_density(std::int32_t max_new_vertices);

  const Surface& surface_;
  std::span<const std::int32_t> loop_;
  std::int32_t rim_;
  Eigen::Vector3d origin_;  ///< coordinates are relative to it, for precision
  std::vector<Eigen::Vector3d> points_;
  std::vector<Triangle> triangles_;
  std::vector<std::int32_t> twin_;
  std::vector<std::int32_t> outgoing_;  ///< at the rim the half-edge along the loop
  std::vector<double> edge_length_;     ///< wanted at each vertex
};

Patch::Patch(const Surface& surface, std::span<const std::int32_t> loop)
    : surface_(surface), loop_(loop), rim_(static_cast<std::int32_t>(loop.size())) {
  origin_ = surface.points[loop[0]].cast<double>();
  for (const std::int32_t v : loop) {
    points_.push_back(surface.points[v].cast<double>() - origin_);
    // The mean over the edges of the fan.
    double sum = 0;
    int count = 0;
    for (std::int32_t h = surface.outgoing[v]; h != kNone; h = surface.ccw(h)) {
      sum += (surface.points[surface.target(h)] - surface.points[v]).cast<double>().norm();
      ++count;
    }
    edge_length_.push_back(sum / count);
  }
}

bool Patch::split_loop() {
  if (rim_ == 3 && face_of(surface_.outgoing[loop_[0]]) == face_of(surface_.outgoing[loop_[1]]) &&
      face_of(surface_.outgoing[loop_[0]]) == face_of(surface_.outgoing[loop_[2]]))
    return false;  // the loop of a lone triangle
  const auto joined = [&](std::int32_t a, std::int32_t b) {
    return joined_in(surface_, loop_[a], loop_[b]);
  };
  LoopSplitter splitter;
  const auto triangles = splitter.split(points_, joined);
  triangles_.assign(triangles.begin(), triangles.end());
  if (!triangles_.empty()) return true;
  std::vector<std::vector<std::int32_t>> stuck;
  if (rim_ <= kLongestCover) {
    stuck.resize(1, std::vector<std::int32_t>(rim_));
    std::iota(stuck[0].begin(), stuck[0].end(), 0);
  } else {
    const auto most = splitter.split_as_far_as_possible(points_, joined, stuck);
    triangles_.assign(most.begin(), most.end());
  }
  double folded_area = 0;
  for (const auto& sub_loop : stuck)
    if (!cover_sub_loop(sub_loop, folded_area)) return false;
  double area = 0;
  for (const Triangle& t : triangles_) area += 0.5 * face_normal(t).norm();
  return folded_area <= kMostFolded * area;
}

/// Covers a part of the loop that crosses itself seen from any side.
bool Patch::cover_sub_loop(const std::vector<std::int32_t>& sub_loop, double& folded_area) {
  const auto n = static_cast<std::int32_t>(sub_loop.size());
  if (n > kLongestCover) return false;
  const std::vector<Eigen::Vector3d> rim = rim_normals();
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> normals;
  for (std::int32_t k = 0; k < n; ++k) {
    const std::int32_t v = sub_loop[k];
    points.push_back(points_[v]);
    // The face beyond a splitting line is not known.
    const bool on_rim = sub_loop[k + 1 == n ? 0 : k + 1] == (v + 1 == rim_ ? 0 : v + 1);
    normals.push_back(on_rim ? rim[v] : Eigen::Vector3d::Zero());
  }
  const LoopCover cover = cover_loop(points, normals, [&](std::int32_t a, std::int32_t b) {
    return joined_in(surface_, loop_[sub_loop[a]], loop_[sub_loop[b]]);
  });
  for (const Triangle& t : cover.triangles)
    triangles_.push_back({sub_loop[t[0]], sub_loop[t[1]], sub_loop[t[2]]});
  folded_area += cover.folded_area;
  return !cover.triangles.empty();
}

/// Unit normals of the faces on the other side of the loop's edges.
std::vector<Eigen::Vector3d> Patch::rim_normals() const {
  std::vector<Eigen::Vector3d> normals;
  for (std::int32_t k = 0; k < rim_; ++k) {
    // The loop runs against the boundary half-edges.
    const std::int32_t v = loop_[k + 1 == rim_ ? 0 : k + 1];
    const auto& t = surface_.triangles[face_of(surface_.outgoing[v])];
    const Eigen::Vector3d a = surface_.points[t[0]].cast<double>();
    const Eigen::Vector3d b = surface_.points[t[1]].cast<double>();
    const Eigen::Vector3d c = surface_.points[t[2]].cast<double>();
    normals.push_back((b - a).cross(c - a).normalized());
  }
  return normals;
}

Eigen::Vector3d Patch::face_normal(const Triangle& t) const {
  return (points_[t[1]] - points_[t[0]]).cross(points_[t[2]] - points_[t[0]]);
}

/// Whether a and b are an edge of the patch or of the surface.
bool Patch::joined(std::int32_t a, std::int32_t b) const {
  if (a < rim_ && b < rim_ && joined_in(surface_, loop_[a], loop_[b])) return true;
  const std::int32_t start = outgoing_[a];
  std::int32_t h = start;
  do {
    if (origin(next(h)) == b || origin(prev(h)) == b) return true;
    h = twin_[prev(h)];
  } while (h != kNone && h != start);
  return false;
}

/// Whether the angles opposite to an inner edge add up to no more than 180 degrees.
bool Patch::delaunay(std::int32_t h) const {
  const auto cot = [&](std::int32_t k) {
    const Eigen::Vector3d& tip = points_[origin(prev(k))];
    const Eigen::Vector3d a = points_[origin(k)] - tip;
    const Eigen::Vector3d b = points_[origin(next(k))] - tip;
    const double sine = a.cross(b).norm();
    const double cosine = a.dot(b);
    return cosine / std::max(sine, 1e-9 * a.norm() * b.norm());
  };
  return cot(h) + cot(twin_[h]) >= -1e-6;
}

void Patch::link(std::int32_t h, std::int32_t twin) {
  twin_[h] = twin;
  if (twin != kNone) twin_[twin] = h;
}

/// Turns the edge of two faces to the other diagonal, unless that is an edge already or folds the
/// patch.
bool Patch::flip(std::int32_t h) {
  const std::int32_t t = twin_[h];
  const std::int32_t f = face_of(h);
  const std::int32_t g = face_of(t);
  const std::int32_t a = origin(h);
  const std::int32_t b = origin(t);
  const std::int32_t c = origin(prev(h));
  const std::int32_t d = origin(prev(t));
  const Triangle new_f{a, d, c};
  const Triangle new_g{d, b, c};
  const Eigen::Vector3d before = face_normal(triangles_[f]) + face_normal(triangles_[g]);
  if (!(face_normal(new_f).dot(before) > 0 && face_normal(new_g).dot(before) > 0)) return false;
  if (joined(c, d)) return false;
  const std::array<std::int32_t, 4> outer{twin_[next(t)], twin_[prev(h)], twin_[prev(t)],
                                          twin_[next(h)]};
  triangles_[f] = new_f;
  triangles_[g] = new_g;
  link(halfedge(f, 0), outer[0]);
  link(halfedge(f, 2), outer[1]);
  link(halfedge(g, 0), outer[2]);
  link(halfedge(g, 1), outer[3]);
  link(halfedge(f, 1), halfedge(g, 2));
  for (const std::int32_t face : {f, g})
    for (int i = 0; i < 3; ++i) {
      const std::int32_t k = halfedge(face, i);
      if (origin(k) >= rim_ || twin_[k] == kNone) outgoing_[origin(k)] = k;
    }
  return true;
}

void Patch::make_delaunay() {
  std::vector<std::int32_t> pending;
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(triangles_.size()); ++f)
    for (int i = 0; i < 3; ++i)
      if (twin_[halfedge(f, i)] > halfedge(f, i)) pending.push_back(halfedge(f, i));
  // On a bent patch flips could go round in circles.
  auto budget = 20 * static_cast<std::int64_t>(triangles_.size());
  while (!pending.empty() && budget > 0) {
    const std::int32_t h = pending.back();
    pending.pop_back();
    if (twin_[h] == kNone || delaunay(h) || !flip(h)) continue;
    --budget;
    const std::int32_t f = face_of(h);
    const std::int32_t g = face_of(twin_[halfedge(f, 1)]);
    for (const std::int32_t k : {halfedge(f, 0), halfedge(f, 2), halfedge(g, 0), halfedge(g, 1)})
      pending.push_back(k);
  }
}

/// Whether the centroid of a face lies farther from its corners than vertices should.
bool Patch::wants_vertex(std::int32_t face) const {
  const Triangle& t = triangles_[face];
  const Eigen::Vector3d centroid = (points_[t[0]] + points_[t[1]] + points_[t[2]]) / 3;
  const double wanted = (edge_length_[t[0]] + edge_length_[t[1]] + edge_length_[t[2]]) / 3;
  for (const std::int32_t v : t) {
    const double reach = std::numbers::sqrt2 * (points_[v] - centroid).norm();
    if (!(reach > wanted && reach > edge_length_[v])) return false;
  }
  return true;
}

void Patch::insert_at_centroid(std::int32_t face) {
  const auto [a, b, c] = triangles_[face];
  const auto v = static_cast<std::int32_t>(points_.size());
  points_.push_back((points_[a] + points_[b] + points_[c]) / 3);
  edge_length_.push_back((edge_length_[a] + edge_length_[b] + edge_length_[c]) / 3);
  const auto f1 = static_cast<std::int32_t>(triangles_.size());
  const std::int32_t f2 = f1 + 1;
  const std::int32_t outer_b = twin_[halfedge(face, 1)];
  const std::int32_t outer_c = twin_[halfedge(face, 2)];
  triangles_[face] = {a, b, v};
  triangles_.push_back({b, c, v});
  triangles_.push_back({c, a, v});
  twin_.resize(4 * triangles_.size(), kNone);
  link(halfedge(f1, 0), outer_b);
  link(halfedge(f2, 0), outer_c);
  link(halfedge(face, 1), halfedge(f1, 2));
  link(halfedge(f1, 1), halfedge(f2, 2));
  link(halfedge(f2, 1), halfedge(face, 2));
  if (face_of(outgoing_[b]) == face) outgoing_[b] = halfedge(f1, 0);
  if (face_of(outgoing_[c]) == face) outgoing_[c] = halfedge(f2, 0);
  outgoing_.push_back(halfedge(face, 2));
}

/// Makes the wanted edges so long that the patch needs no more than so many vertices.
void Patch::limit_density(std::int32_t max_new_vertices) {
  double area = 0;
  for (const Triangle& t : triangles_) area += 0.5 * face_normal(t).norm();
  // Two equilateral triangles for each vertex.
  const double shortest = std::sqrt(area / std::max(max_new_vertices, 1) * 2 / std::numbers::sqrt3);
  for (double& length : edge_length_) length = std::max(length, shortest);
}

void Patch::refine(std::int32_t max_new_vertices) {
  twin_ = pair_twins(group_edges(triangles_, rim_), triangles_.size());
  outgoing_.assign(rim_, kNone);
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(triangles_.size()); ++f)
    for (int i = 0; i < 3; ++i)
      if (twin_[halfedge(f, i)] == kNone) outgoing_[triangles_[f][i]] = halfedge(f, i);
  make_delaunay();
  limit_density(max_new_vertices);
  for (int round = 0; round < kRounds; ++round) {
    const auto faces = static_cast<std::int32_t>(triangles_.size());
    for (std::int32_t f = 0; f < faces; ++f)
      if (wants_vertex(f)) insert_at_centroid(f);
    make_delaunay();
    if (faces == static_cast<std::int32_t>(triangles_.size())) break;
  }
}

/// The patch with the faces round it, `rings` deep.
struct Patch::Surroundings {
  std::vector<Eigen::Vector3d> points;  ///< those of the patch first
  std::vector<PlateRole> roles;
  std::vector<Triangle> triangles;  ///< without those of the patch
  double mean_edge_length = 0;      ///< of those triangles
};

Patch::Surroundings Patch::surroundings(int rings) const {
  Surroundings result;
  result.points = points_;
  result.roles.assign(points_.size(), PlateRole::free);
  std::unordered_map<std::int32_t, std::int32_t> index;  // of vertices of the surface
  std::unordered_set<std::int32_t> faces;
  for (std::int32_t k = 0; k < rim_; ++k) {
    index.emplace(loop_[k], k);
    result.roles[k] = PlateRole::tied;
  }
  std::vector<std::int32_t> ring(loop_.begin(), loop_.end());
  for (int depth = 1; depth <= rings; ++depth) {
    std::vector<std::int32_t> next_ring;
    for (const std::int32_t v : ring) {
      std::int32_t h = surface_.outgoing[v];
      do {
        if (faces.insert(face_of(h)).second) {
          Triangle t = surface_.triangles[face_of(h)];
          for (std::int32_t& w : t) {
            const auto here = static_cast<std::int32_t>(result.points.size());
            const auto [entry, is_new] = index.emplace(w, here);
            if (is_new) {
              result.points.push_back(surface_.points[w].cast<double>() - origin_);
              // Fans have to be closed.
              result.roles.push_back(depth == rings || surface_.on_boundary(w) ? PlateRole::held
                                                                               : PlateRole::tied);
              next_ring.push_back(w);
            }
            w = entry->second;
          }
          result.triangles.push_back(t);
        }
        h = surface_.ccw(h);
      } while (h != kNone && h != surface_.outgoing[v]);
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
  if (static_cast<std::int32_t>(points_.size()) == rim_) return;
  Surroundings around = surroundings(kRings);
  const std::vector<Eigen::Vector3d> targets = around.points;
  for (int k = 0; k < kFairings; ++k) {
    std::vector<Triangle> triangles = triangles_;
    triangles.insert(triangles.end(), around.triangles.begin(), around.triangles.end());
    if (!fair_plate(around.points, targets, around.roles, triangles,
                    kWaveLength * around.mean_edge_length))
      return;
    std::copy(around.points.begin() + rim_, around.points.begin() + points_.size(),
              points_.begin() + rim_);
    make_delaunay();
  }
}

HolePatch Patch::result() const {
  HolePatch patch;
  patch.triangles = triangles_;
  for (std::size_t k = rim_; k < points_.size(); ++k)
    patch.points.push_back((points_[k] + origin_).cast<float>());
  return patch;
}

}  // namespace

HolePatch make_hole_patch(const Surface& surface, std::span<const std::int32_t> loop,
                          const HolePatchOptions& options) {
  Patch patch(surface, loop);
  if (!patch.split_loop()) return {};
  if (options.refine) {
    patch.refine(options.max_new_vertices);
    patch.fair();
  }
  return patch.result();
}

}  // namespace semigeo::kernels
