#include "kernels/repair/remeshing.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "kernels/surface/circulators.hpp"
#include "kernels/surface/quadratic_face.hpp"
#include "kernels/surface/vertex_order.hpp"
#include "kernels/surface/vertex_rows.hpp"

namespace semigeo::kernels {
namespace {

/// The number of faces beyond which a vertex stays where it is when another joins it: to examine
/// all of its edges again each time would cost the square of their number.
constexpr int kLargeFan = 64;
/// The sides of what is left of a surface that has vanished, in shortest sides.
constexpr double kRemnantEdge = 10;

bool has_large_fan(const Connectivity& mesh, std::int32_t v) {
  int faces = 0;
  for ([[maybe_unused]] const std::int32_t h : outgoing(mesh, v))
    if (++faces > kLargeFan) return true;
  return false;
}

/// Returns the squared least height of a triangle.
double squared_height(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                      const Eigen::Vector3d& c) {
  const double longest2 =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return longest2 > 0 ? (b - a).cross(c - a).squaredNorm() / longest2 : 0;
}

template <typename Entry>
void push(std::vector<Entry>& heap, const Entry& entry) {
  heap.push_back(entry);
  std::push_heap(heap.begin(), heap.end(), std::greater<>());
}

template <typename Entry>
Entry pop(std::vector<Entry>& heap) {
  std::pop_heap(heap.begin(), heap.end(), std::greater<>());
  const Entry entry = heap.back();
  heap.pop_back();
  return entry;
}

}  // namespace

double LevelMesh::height2(std::int32_t f) const {
  const auto& t = connectivity.triangles[f];
  return squared_height(point(t[0]), point(t[1]), point(t[2]));
}

void LevelMesh::reorder(const std::vector<std::int32_t>& order) {
  std::vector<std::int32_t> faces;
  connectivity = reordered(connectivity, order, &faces);
  gather_rows(vertex_rows(), order);
  face_filled = gathered(face_filled, faces);
}

void find_odd_faces(const LevelMesh& mesh, std::int32_t begin, std::int32_t end, double length,
                    std::vector<std::int32_t>& faces) {
  // No side is shorter than the least height.
  for (std::int32_t f = begin; f < end; ++f)
    if (!(mesh.height2(f) >= length * length)) faces.push_back(f);
}

void find_long_edges(const LevelMesh& mesh, std::int32_t begin, std::int32_t end, double length,
                     std::vector<std::int32_t>& edges) {
  for (const std::int32_t h : kernels::edges(mesh.connectivity, begin, end))
    if (mesh.length2(h) > length * length) edges.push_back(h);
}

Remesher::Remesher(LevelMesh& mesh, bool curved)
    : mesh_(mesh), editor_(mesh.connectivity), curved_(curved), first_new_(mesh.vertex_count()) {}

void Remesher::drop_part(std::int32_t face) {
  const SurfaceEditor::Dropped dropped = editor_.drop_part(face);
  counts_.removed += dropped.vertices;
  counts_.dropped_faces += dropped.faces;
  ++counts_.dropped_parts;
  parts_changed_ = true;
}

void Remesher::push_edge(std::int32_t h) {
  if (h == kNone || !editor_.has_face(face_of(h))) return;
  const double length2 = mesh_.length2(h);
  if (length2 < shortest2_) push(edges_, {length2, h});
}

void Remesher::push_face(std::int32_t f) {
  if (!editor_.has_face(f)) return;
  const double height2 = mesh_.height2(f);
  if (!(height2 >= shortest2_)) push(faces_, {height2, f});
}

void Remesher::push_fan(std::int32_t v) {
  for (const std::int32_t h : outgoing(mesh_.connectivity, v)) {
    push_edge(h);
    if (mesh_.connectivity.twin[prev(h)] == kNone) push_edge(prev(h));
    push_face(face_of(h));
  }
}

void Remesher::remove_odd(std::span<const std::int32_t> faces, double shortest) {
  shortest2_ = shortest * shortest;
  edges_.clear();
  faces_.clear();
  for (const std::int32_t f : faces) {
    push_face(f);
    for (int i = 0; i < 3; ++i) push_edge(halfedge(f, i));
  }
  remove_short_edges();
  while (!faces_.empty()) {
    const Entry face = pop(faces_);
    if (!editor_.has_face(face.index) || mesh_.height2(face.index) != face.measure) continue;
    remove_flat_face(face.index);
    remove_short_edges();
  }
}

void Remesher::remove_short_edges() {
  while (!edges_.empty()) {
    const Entry edge = pop(edges_);
    if (!editor_.has_face(face_of(edge.index)) || mesh_.length2(edge.index) != edge.measure)
      continue;
    remove_edge(edge.index);
  }
}

/// Makes the triangle or tetrahedron of h regular if it is all that is left. Returns whether it is.
bool Remesher::keep_remnant(std::int32_t h) {
  const Connectivity& surface = mesh_.connectivity;
  const std::int32_t t = surface.twin[h];
  if (face_count() != (t == kNone ? 1 : 4)) return false;
  const std::array<std::int32_t, 4> corners = {surface.origin(h), surface.target(h),
                                               surface.origin(prev(h)),
                                               t == kNone ? kNone : surface.origin(prev(t))};
  const int count = t == kNone ? 3 : 4;
  // Every other corner of a cube of this half side; the first three anticlockwise from outside.
  const double a = kRemnantEdge * std::sqrt(shortest2_ / 8);
  const Eigen::Vector3d regular[] = {{a, a, a}, {-a, a, -a}, {-a, -a, a}, {a, -a, -a}};
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  for (int i = 0; i < count; ++i) shift += (mesh_.point(corners[i]) - regular[i]) / count;
  for (int i = 0; i < count; ++i) {
    mesh_.points[corners[i]].head<3>() = (regular[i] + shift).cast<float>();
    mesh_.normals[corners[i]] = regular[i].normalized().cast<float>();
  }
  vanished_ = true;
  return true;
}

/// Tells whether the two faces of an edge would be less flat with the other diagonal between them.
bool Remesher::flip_is_better(std::int32_t h) const {
  const std::int32_t t = mesh_.connectivity.twin[h];
  if (t == kNone) return false;
  const Eigen::Vector3d a = mesh_.point(mesh_.connectivity.origin(h));
  const Eigen::Vector3d b = mesh_.point(mesh_.connectivity.target(h));
  const Eigen::Vector3d c = mesh_.point(mesh_.connectivity.origin(prev(h)));
  const Eigen::Vector3d d = mesh_.point(mesh_.connectivity.origin(prev(t)));
  return std::min(squared_height(a, d, c), squared_height(d, b, c)) >
         std::min(squared_height(a, b, c), squared_height(b, a, d));
}

void Remesher::remove_flat_face(std::int32_t f) {
  std::int32_t longest = halfedge(f, 0);
  std::int32_t shortest = longest;
  for (int i = 1; i < 3; ++i) {
    const std::int32_t h = halfedge(f, i);
    if (mesh_.length2(h) > mesh_.length2(longest)) longest = h;
    if (mesh_.length2(h) < mesh_.length2(shortest)) shortest = h;
  }
  if (!flip_is_better(longest) || !editor_.may_flip(longest)) {
    const RemeshCounts before = counts_;
    remove_edge(shortest);
    // What was in the way of the edge may have gone without it. If nothing was done, as with a last
    // triangle, another try would do nothing either.
    if (counts_ != before) push_face(f);
    return;
  }
  const std::int32_t h = editor_.flip(longest);
  ++counts_.flipped;
  push_edge(h);
  push_face(face_of(h));
  push_face(face_of(mesh_.connectivity.twin[h]));
}

/// Makes one vertex of the two ends of an edge, or removes what prevents it.
void Remesher::remove_edge(std::int32_t edge) {
  const Connectivity& surface = mesh_.connectivity;
  const std::int32_t h = editor_.from_larger_fan(edge);
  const SurfaceEditor::Collapse check = editor_.may_collapse(h);
  switch (check.obstacle) {
    case SurfaceEditor::Obstacle::kNothing:
      merge(h);
      break;
    case SurfaceEditor::Obstacle::kPart:
      if (!keep_remnant(h)) drop_part(face_of(h));
      break;
    case SurfaceEditor::Obstacle::kChord: {
      const std::int32_t t = surface.twin[h];
      editor_.cut_chord(h);
      ++counts_.torn;
      parts_changed_ = true;
      carry_new_vertices();
      push_edge(h);
      push_edge(t);
      break;
    }
    case SurfaceEditor::Obstacle::kCycle: {
      if (const std::int32_t spoke = spoke_inside(h, check.third); spoke != kNone) {
        // Of the three faces there one is left, between the vertices of the cycle.
        const std::int32_t left = face_of(surface.ccw(surface.twin[spoke]));
        absorb(spoke);
        for (int i = 0; i < 3; ++i) push_edge(halfedge(left, i));
        push_face(left);
        break;
      }
      const auto covers = editor_.cut_cycle(surface.origin(h), surface.target(h), check.third);
      ++counts_.torn;
      parts_changed_ = true;
      carry_new_vertices();
      for (const std::int32_t f : covers) {
        if (f == kNone) continue;
        mark_face(f, 0);
        push_face(f);
        for (int i = 0; i < 3; ++i) push_edge(halfedge(f, i));
      }
      break;
    }
  }
}

/// Returns the least cosine between the normals of the faces round v before and after a move of v
/// to p. Faces that contain `other` do not count: they vanish.
double Remesher::least_cosine(std::int32_t v, std::int32_t other, const Eigen::Vector3d& p) const {
  double least = 1;
  const Eigen::Vector3d old = mesh_.point(v);
  for (const std::int32_t h : outgoing(mesh_.connectivity, v)) {
    const std::int32_t b = mesh_.connectivity.target(h);
    const std::int32_t c = mesh_.connectivity.origin(prev(h));
    if (b == other || c == other) continue;
    const Eigen::Vector3d pb = mesh_.point(b);
    const Eigen::Vector3d pc = mesh_.point(c);
    const Eigen::Vector3d before = (pb - old).cross(pc - old);
    const Eigen::Vector3d after = (pb - p).cross(pc - p);
    const double size = before.norm() * after.norm();
    if (size > 0) least = std::min(least, before.dot(after) / size);
  }
  return least;
}

/// Returns where two vertices become one: on the boundary if one of them lies there; otherwise half
/// way if they are close and no face is turned over by it, and otherwise where faces turn least.
Eigen::Vector3d Remesher::merged_point(std::int32_t a, std::int32_t b) const {
  Eigen::Vector3d pa = mesh_.point(a);
  Eigen::Vector3d pb = mesh_.point(b);
  const bool a_fixed = mesh_.connectivity.on_boundary(a);
  const bool b_fixed = mesh_.connectivity.on_boundary(b);
  if (a_fixed != b_fixed) return a_fixed ? pa : pb;
  if (has_large_fan(mesh_.connectivity, a)) return pa;
  const bool close = (pb - pa).squaredNorm() < shortest2_;
  Eigen::Vector3d best = pa;
  double best_cosine = -2;
  for (const Eigen::Vector3d& p : {Eigen::Vector3d((pa + pb) / 2), pa, pb}) {
    const double cosine = std::min(least_cosine(a, b, p), least_cosine(b, a, p));
    if (close && cosine > 0) return p;
    if (!(cosine > best_cosine)) continue;
    best_cosine = cosine;
    best = p;
  }
  return best;
}

/// Returns a half-edge to the vertex inside the cycle of the ends of h and `third`, if one side of
/// it has a single vertex; otherwise kNone.
std::int32_t Remesher::spoke_inside(std::int32_t h, std::int32_t third) const {
  const Connectivity& surface = mesh_.connectivity;
  for (const std::int32_t side : {h, surface.twin[h]}) {
    if (side == kNone) continue;
    // Round the apex: to the origin of `side`, to its target, and to the third.
    const std::int32_t start = prev(side);
    const std::int32_t second = surface.ccw(start);
    const std::int32_t last = second == kNone ? kNone : surface.ccw(second);
    if (last != kNone && surface.target(last) == third && surface.ccw(last) == start)
      return surface.twin[start];
  }
  return kNone;
}

/// Makes one vertex of the ends of h; the survivor stays where it is.
void Remesher::absorb(std::int32_t h) {
  const std::int32_t a = editor_.survivor(h);
  carry_over(a, mesh_.connectivity.origin(h) + mesh_.connectivity.target(h) - a);
  editor_.collapse(h);
  ++counts_.collapsed;
  ++counts_.removed;
}

/// Gives vertex a what it keeps of b, which joins it, except for the place.
void Remesher::carry_over(std::int32_t a, std::int32_t b) {
  const Eigen::Vector3f normal = mesh_.normals[a] + mesh_.normals[b];
  if (normal.norm() > 0) mesh_.normals[a] = normal.normalized();
  std::int32_t& source = mesh_.source[a];
  const std::int32_t other = mesh_.source[b];
  if (source == kNone || (other != kNone && other < source)) {
    source = other;
    mesh_.initial_points[a] = mesh_.initial_points[b];
  }
  if (!mesh_.vertex_filled.empty()) mesh_.vertex_filled[a] &= mesh_.vertex_filled[b];
}

void Remesher::merge(std::int32_t h) {
  const std::int32_t a = editor_.survivor(h);
  const std::int32_t b = mesh_.connectivity.origin(h) + mesh_.connectivity.target(h) - a;
  const Eigen::Vector3f p = merged_point(a, b).cast<float>();
  const bool stays = p == mesh_.points[a].head<3>();
  std::vector<std::int32_t> joining;
  if (stays)
    for (const std::int32_t g : outgoing(mesh_.connectivity, b)) joining.push_back(g);
  mesh_.points[a].head<3>() = p;
  absorb(h);
  if (!stays) push_fan(a);
  for (const std::int32_t g : joining) {
    push_edge(g);
    push_edge(prev(g));
    push_face(face_of(g));
  }
}

Eigen::Vector3f Remesher::middle(std::int32_t a, std::int32_t b) const {
  const Eigen::Vector3f p = mesh_.points[a].head<3>();
  const Eigen::Vector3f q = mesh_.points[b].head<3>();
  Eigen::Vector3f m = (p + q) / 2;
  if (curved_) m += edge_bulge(p, q, mesh_.normals[a], mesh_.normals[b]) / 4;
  return m;
}

/// Gives vertices that the editor has made what the vertices have that they come from.
void Remesher::carry_new_vertices() {
  while (mesh_.vertex_count() < mesh_.connectivity.vertex_count()) {
    const auto birth = editor_.births()[mesh_.vertex_count() - first_new_];
    append_row_copy(mesh_.vertex_rows(), birth.first);
    if (birth.second != kNone) put_between(birth.first, birth.second);
    ++counts_.inserted;
  }
}

/// Moves the last vertex, a copy of a, to the middle of a and b.
void Remesher::put_between(std::int32_t a, std::int32_t b) {
  mesh_.points.back().head<3>() = middle(a, b);
  const Eigen::Vector3f sum = mesh_.normals[a] + mesh_.normals[b];
  if (sum.norm() > 0) mesh_.normals.back() = sum.normalized();
  mesh_.source.back() = kNone;
  mesh_.initial_points.back() = (mesh_.initial_points[a] + mesh_.initial_points[b]) / 2;
  if (!mesh_.vertex_filled.empty()) mesh_.vertex_filled.back() &= mesh_.vertex_filled[b];
}

void Remesher::mark_face(std::int32_t f, std::uint8_t filled) {
  if (mesh_.face_filled.empty()) return;
  mesh_.face_filled.resize(mesh_.connectivity.triangles.size(), 0);
  mesh_.face_filled[f] = filled;
}

/// Halves an edge. Returns false, and does nothing, if a new face would be too small.
bool Remesher::split(std::int32_t h, double shortest) {
  const Connectivity& surface = mesh_.connectivity;
  const std::int32_t t = surface.twin[h];
  const Eigen::Vector3d m = middle(surface.origin(h), surface.target(h)).cast<double>();
  for (const std::int32_t g : {h, t})
    for (int i = 0; i < 2 && g != kNone; ++i) {
      const Eigen::Vector3d end = mesh_.point(i == 0 ? surface.origin(g) : surface.target(g));
      const double height2 = squared_height(m, end, mesh_.point(surface.origin(prev(g))));
      if (!(height2 >= shortest * shortest)) return false;
    }
  const bool marked = !mesh_.face_filled.empty();
  const std::uint8_t here = marked ? mesh_.face_filled[face_of(h)] : 0;
  const std::uint8_t there = marked && t != kNone ? mesh_.face_filled[face_of(t)] : 0;
  const std::int32_t v = editor_.split(h);
  ++counts_.split;
  carry_new_vertices();
  mark_face(face_of(surface.outgoing[v]), here);
  if (t != kNone) mark_face(face_of(surface.twin[h]), there);
  return true;
}

void Remesher::refine(std::span<const std::int32_t> edges, std::int64_t faces, double longest,
                      double shortest) {
  if (face_count() >= faces || vanished_) return;
  Heap heap;
  const auto put = [&](std::int32_t h) {
    const double length2 = mesh_.length2(h);
    if (length2 > longest * longest) heap.push_back({length2, h});
    return length2 > longest * longest;
  };
  for (const std::int32_t h : edges)
    if (editor_.has_face(face_of(h))) put(h);
  std::make_heap(heap.begin(), heap.end());
  while (!heap.empty() && face_count() < faces) {
    std::pop_heap(heap.begin(), heap.end());
    const Entry edge = heap.back();
    heap.pop_back();
    const bool current = mesh_.length2(edge.index) == edge.measure;
    if (!current || !split(edge.index, shortest)) continue;
    const auto v = static_cast<std::int32_t>(mesh_.vertex_count()) - 1;
    for (const std::int32_t h : outgoing(mesh_.connectivity, v)) {
      if (put(h)) std::push_heap(heap.begin(), heap.end());
      const std::int32_t last = prev(h);
      if (mesh_.connectivity.twin[last] == kNone && put(last))
        std::push_heap(heap.begin(), heap.end());
    }
  }
}

/// Returns the vertices that are left, each new one behind the old one that it comes from.
std::vector<std::int32_t> Remesher::order_of_survivors() {
  const auto& births = editor_.births();
  const auto first_new = static_cast<std::int32_t>(first_new_);
  std::vector<std::int32_t> anchor(births.size());
  std::vector<std::pair<std::int32_t, std::int32_t>> added;
  for (std::size_t k = 0; k < births.size(); ++k) {
    const std::int32_t first = births[k].first;
    anchor[k] = first < first_new ? first : anchor[first - first_new];
    const auto v = first_new + static_cast<std::int32_t>(k);
    if (editor_.has_vertex(v)) added.emplace_back(anchor[k], v);
  }
  std::sort(added.begin(), added.end());
  std::vector<std::int32_t> order;
  order.reserve(editor_.vertex_count());
  auto next_added = added.begin();
  for (std::int32_t v = 0; v < first_new; ++v) {
    if (editor_.has_vertex(v)) order.push_back(v);
    for (; next_added != added.end() && next_added->first == v; ++next_added)
      order.push_back(next_added->second);
  }
  return order;
}

RemeshCounts Remesher::finish() {
  if (counts_ == RemeshCounts{}) return counts_;
  mesh_.reorder(order_of_survivors());
  if (!parts_changed_) return counts_;
  mesh_.part_count = number_parts(mesh_.connectivity, mesh_.part);
  const std::vector<std::int32_t>& part = mesh_.part;
  if (std::is_sorted(part.begin(), part.end())) return counts_;
  std::vector<std::int32_t> order(part.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::int32_t a, std::int32_t b) { return part[a] < part[b]; });
  mesh_.reorder(order);
  return counts_;
}

}  // namespace semigeo::kernels
