#include "kernels/remeshing.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <utility>

#include "kernels/quadratic_face.hpp"
#include "kernels/vertex_order.hpp"

namespace semigeo::kernels {
namespace {

/// A vertex with more faces stays where it is when another joins it: to look at all of its edges
/// again each time would cost the square of their number.
constexpr int kLargeFan = 64;

template <typename Value>
void gather(std::vector<Value>& values, const std::vector<std::int32_t>& order) {
  if (values.empty()) return;
  std::vector<Value> result(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) result[i] = values[order[i]];
  values = std::move(result);
}

template <typename Wanted>
void find_edges(const LevelMesh& mesh, std::int32_t begin, std::int32_t end,
                std::vector<std::int32_t>& edges, const Wanted& wanted) {
  for (std::int32_t f = begin; f < end; ++f) {
    const auto& t = mesh.surface.triangles[f];
    if (t[0] == kNone) continue;
    const std::array<Eigen::Vector3d, 3> p = {mesh.point(t[0]), mesh.point(t[1]), mesh.point(t[2])};
    for (int i = 0; i < 3; ++i) {
      const std::int32_t h = halfedge(f, i);
      if (mesh.surface.twin[h] > h) continue;  // found from the other side
      if (wanted((p[i == 2 ? 0 : i + 1] - p[i]).squaredNorm())) edges.push_back(h);
    }
  }
}

}  // namespace

RemeshCounts& RemeshCounts::operator+=(const RemeshCounts& other) {
  collapsed += other.collapsed;
  split += other.split;
  torn += other.torn;
  inserted += other.inserted;
  removed += other.removed;
  dropped_parts += other.dropped_parts;
  dropped_faces += other.dropped_faces;
  return *this;
}

void find_short_edges(const LevelMesh& mesh, std::int32_t begin, std::int32_t end, double length,
                      std::vector<std::int32_t>& edges) {
  find_edges(mesh, begin, end, edges, [&](double length2) { return length2 < length * length; });
}

void find_long_edges(const LevelMesh& mesh, std::int32_t begin, std::int32_t end, double length,
                     std::vector<std::int32_t>& edges) {
  find_edges(mesh, begin, end, edges, [&](double length2) { return length2 > length * length; });
}

Remesher::Remesher(LevelMesh& mesh, bool curved)
    : mesh_(mesh), editor_(mesh.surface), curved_(curved), first_new_(mesh.vertex_count()) {}

void Remesher::drop_part(std::int32_t face) {
  const SurfaceEditor::Dropped dropped = editor_.drop_part(face);
  counts_.removed += dropped.vertices;
  counts_.dropped_faces += dropped.faces;
  ++counts_.dropped_parts;
  parts_changed_ = true;
}

/// The edge still is what it was when it was put on the heap; if it has changed, it was put there
/// again.
bool Remesher::current(const Edge& edge) const {
  return editor_.has_face(face_of(edge.h)) && mesh_.length2(edge.h) == edge.length2;
}

void Remesher::push_short(std::int32_t h, double shortest) {
  if (h == kNone || !editor_.has_face(face_of(h))) return;
  const double length2 = mesh_.length2(h);
  if (!(length2 < shortest * shortest)) return;
  heap_.push_back({length2, h});
  std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
}

void Remesher::push_fan(std::int32_t v, double shortest) {
  editor_.each_corner(v, [&](std::int32_t h) {
    push_short(h, shortest);
    if (mesh_.surface.twin[prev(h)] == kNone) push_short(prev(h), shortest);
  });
}

void Remesher::collapse(std::span<const std::int32_t> edges, double shortest) {
  heap_.clear();
  for (const std::int32_t h : edges)
    if (editor_.has_face(face_of(h))) heap_.push_back({mesh_.length2(h), h});
  std::make_heap(heap_.begin(), heap_.end(), std::greater<>());
  const Surface& surface = mesh_.surface;
  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
    const Edge edge = heap_.back();
    heap_.pop_back();
    if (!current(edge)) continue;
    const std::int32_t h = editor_.from_larger_fan(edge.h);
    const SurfaceEditor::Collapse check = editor_.may_collapse(h);
    switch (check.obstacle) {
      case SurfaceEditor::Obstacle::none:
        merge(h, shortest);
        break;
      case SurfaceEditor::Obstacle::part:
        drop_part(face_of(h));
        break;
      case SurfaceEditor::Obstacle::chord: {
        const std::int32_t t = surface.twin[h];
        editor_.cut_chord(h);
        ++counts_.torn;
        parts_changed_ = true;
        carry_new_vertices();
        push_short(h, shortest);
        push_short(t, shortest);
        break;
      }
      case SurfaceEditor::Obstacle::cycle: {
        if (const std::int32_t spoke = spoke_inside(h, check.third); spoke != kNone) {
          const std::int32_t keeper = surface.origin(spoke);
          absorb(spoke);
          push_fan(keeper, shortest);
          break;
        }
        const auto covers = editor_.cut_cycle(surface.origin(h), surface.target(h), check.third);
        ++counts_.torn;
        parts_changed_ = true;
        carry_new_vertices();
        for (const std::int32_t f : covers) {
          if (f == kNone) continue;
          mark_face(f, 0);
          for (int i = 0; i < 3; ++i) push_short(halfedge(f, i), shortest);
        }
        break;
      }
    }
  }
}

/// The least cosine by which faces round v would turn if it moved to p; those with `other` are not
/// counted, they vanish.
double Remesher::least_cosine(std::int32_t v, std::int32_t other, const Eigen::Vector3d& p) const {
  double least = 1;
  const Eigen::Vector3d old = mesh_.point(v);
  editor_.each_corner(v, [&](std::int32_t h) {
    const std::int32_t b = mesh_.surface.target(h);
    const std::int32_t c = mesh_.surface.origin(prev(h));
    if (b == other || c == other) return;
    const Eigen::Vector3d pb = mesh_.point(b);
    const Eigen::Vector3d pc = mesh_.point(c);
    const Eigen::Vector3d before = (pb - old).cross(pc - old);
    const Eigen::Vector3d after = (pb - p).cross(pc - p);
    const double size = before.norm() * after.norm();
    if (size > 0) least = std::min(least, before.dot(after) / size);
  });
  return least;
}

/// Where two vertices become one: on the boundary if one of them is; else half way, unless that
/// would turn a face over and an end would not.
Eigen::Vector3d Remesher::merged_point(std::int32_t a, std::int32_t b) const {
  const Eigen::Vector3d pa = mesh_.point(a);
  const Eigen::Vector3d pb = mesh_.point(b);
  const bool a_fixed = mesh_.surface.on_boundary(a);
  const bool b_fixed = mesh_.surface.on_boundary(b);
  if (a_fixed != b_fixed) return a_fixed ? pa : pb;
  int fan = 0;
  editor_.each_corner(a, [&](std::int32_t) { ++fan; });
  if (fan > kLargeFan) return pa;
  Eigen::Vector3d best = pa;
  double best_cosine = -2;
  for (const Eigen::Vector3d& p : {Eigen::Vector3d((pa + pb) / 2), pa, pb}) {
    const double cosine = std::min(least_cosine(a, b, p), least_cosine(b, a, p));
    if (cosine > 0) return p;
    if (!(cosine > best_cosine)) continue;
    best_cosine = cosine;
    best = p;
  }
  return best;
}

/// If the cycle of the ends of h and `third` has but one vertex on one of its sides: a half-edge
/// to that vertex.
std::int32_t Remesher::spoke_inside(std::int32_t h, std::int32_t third) const {
  const Surface& surface = mesh_.surface;
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

/// Makes the target of h one with its origin, which stays where it is.
void Remesher::absorb(std::int32_t h) {
  carry_over(mesh_.surface.origin(h), mesh_.surface.target(h));
  editor_.collapse(h);
  ++counts_.collapsed;
  ++counts_.removed;
}

/// What a vertex keeps of one that joins it, besides the place.
void Remesher::carry_over(std::int32_t a, std::int32_t b) {
  const Eigen::Vector3f normal = mesh_.normals[a] + mesh_.normals[b];
  if (normal.norm() > 0) mesh_.normals[a] = normal.normalized();
  std::int32_t& source = mesh_.source[a];
  const std::int32_t other = mesh_.source[b];
  if (source == kNone || (other != kNone && other < source)) source = other;
  if (!mesh_.vertex_filled.empty()) mesh_.vertex_filled[a] &= mesh_.vertex_filled[b];
}

void Remesher::merge(std::int32_t h, double shortest) {
  const std::int32_t a = mesh_.surface.origin(h);
  const std::int32_t b = mesh_.surface.target(h);
  const Eigen::Vector3f p = merged_point(a, b).cast<float>();
  const bool stays = p == mesh_.points[a].head<3>();
  std::vector<std::int32_t> joining;
  if (stays)
    editor_.each_corner(b, [&](std::int32_t g) {
      joining.push_back(g);
      joining.push_back(prev(g));
    });

  mesh_.points[a].head<3>() = p;
  absorb(h);
  if (!stays) push_fan(a, shortest);
  for (const std::int32_t g : joining) push_short(g, shortest);
}

Eigen::Vector3f Remesher::middle(std::int32_t a, std::int32_t b) const {
  const Eigen::Vector3f p = mesh_.points[a].head<3>();
  const Eigen::Vector3f q = mesh_.points[b].head<3>();
  Eigen::Vector3f m = (p + q) / 2;
  if (curved_) m += edge_bulge(p, q, mesh_.normals[a], mesh_.normals[b]).head<3>() / 4;
  return m;
}

/// New vertices get all that old ones have.
void Remesher::carry_new_vertices() {
  while (mesh_.vertex_count() < static_cast<std::int64_t>(mesh_.surface.outgoing.size())) {
    const auto birth = editor_.births()[mesh_.vertex_count() - first_new_];
    const std::int32_t a = birth.first;
    const std::int32_t b = birth.second;
    const bool copy = b == kNone;
    Eigen::Vector4f point = mesh_.points[a];
    Eigen::Vector3f normal = mesh_.normals[a];
    if (!copy) {
      point.head<3>() = middle(a, b);
      const Eigen::Vector3f sum = normal + mesh_.normals[b];
      if (sum.norm() > 0) normal = sum.normalized();
    }
    mesh_.points.push_back(point);
    mesh_.normals.push_back(normal);
    mesh_.source.push_back(copy ? mesh_.source[a] : kNone);
    mesh_.surface.part.push_back(mesh_.surface.part[a]);
    if (!mesh_.vertex_filled.empty()) {
      const std::uint8_t filled = mesh_.vertex_filled[a];
      mesh_.vertex_filled.push_back(copy ? filled : filled & mesh_.vertex_filled[b]);
    }
    ++counts_.inserted;
  }
}

void Remesher::mark_face(std::int32_t f, std::uint8_t filled) {
  if (mesh_.face_filled.empty()) return;
  mesh_.face_filled.resize(mesh_.surface.triangles.size(), 0);
  mesh_.face_filled[f] = filled;
}

/// False if a new edge would be too short.
bool Remesher::split(std::int32_t h, double shortest) {
  const Surface& surface = mesh_.surface;
  const std::int32_t t = surface.twin[h];
  const Eigen::Vector3d m = middle(surface.origin(h), surface.target(h)).cast<double>();
  for (const std::int32_t v : {surface.origin(h), surface.target(h), surface.origin(prev(h)),
                               t == kNone ? kNone : surface.origin(prev(t))})
    if (v != kNone && !((mesh_.point(v) - m).squaredNorm() >= shortest * shortest)) return false;
  const std::uint8_t here = mesh_.face_filled.empty() ? 0 : mesh_.face_filled[face_of(h)];
  const std::uint8_t there =
      mesh_.face_filled.empty() || t == kNone ? 0 : mesh_.face_filled[face_of(t)];
  const std::int32_t v = editor_.split(h);
  ++counts_.split;
  carry_new_vertices();
  mark_face(face_of(surface.outgoing[v]), here);
  if (t != kNone) mark_face(face_of(surface.twin[h]), there);
  return true;
}

void Remesher::refine(std::span<const std::int32_t> edges, std::int64_t faces, double longest,
                      double shortest) {
  if (face_count() >= faces) return;
  heap_.clear();
  const auto push = [&](std::int32_t h) {
    const double length2 = mesh_.length2(h);
    if (length2 > longest * longest) heap_.push_back({length2, h});
    return length2 > longest * longest;
  };
  for (const std::int32_t h : edges)
    if (editor_.has_face(face_of(h))) push(h);
  std::make_heap(heap_.begin(), heap_.end());
  while (!heap_.empty() && face_count() < faces) {
    std::pop_heap(heap_.begin(), heap_.end());
    const Edge edge = heap_.back();
    heap_.pop_back();
    if (!current(edge) || !split(edge.h, shortest)) continue;
    const auto v = static_cast<std::int32_t>(mesh_.vertex_count()) - 1;
    editor_.each_corner(v, [&](std::int32_t h) {
      if (push(h)) std::push_heap(heap_.begin(), heap_.end());
      const std::int32_t last = prev(h);
      if (mesh_.surface.twin[last] == kNone && push(last))
        std::push_heap(heap_.begin(), heap_.end());
    });
  }
}

/// The vertices that are left, each new one behind the old one that it comes from.
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

void Remesher::reorder(const std::vector<std::int32_t>& order) {
  std::vector<std::int32_t> faces;
  mesh_.surface = reordered(mesh_.surface, order, &faces);
  gather(mesh_.points, order);
  gather(mesh_.normals, order);
  gather(mesh_.source, order);
  gather(mesh_.vertex_filled, order);
  gather(mesh_.face_filled, faces);
}

RemeshCounts Remesher::finish() {
  if (counts_ == RemeshCounts{}) return counts_;
  reorder(order_of_survivors());
  if (!parts_changed_) return counts_;
  number_parts(mesh_.surface);
  const std::vector<std::int32_t>& part = mesh_.surface.part;
  if (std::is_sorted(part.begin(), part.end())) return counts_;
  std::vector<std::int32_t> order(part.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::int32_t a, std::int32_t b) { return part[a] < part[b]; });
  reorder(order);
  return counts_;
}

}  // namespace semigeo::kernels
