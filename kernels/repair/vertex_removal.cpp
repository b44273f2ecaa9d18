#include "kernels/repair/vertex_removal.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace semigeo::kernels {
namespace {

/// Rings with more vertices are not worth the time.
constexpr std::size_t kLargestRing = 40;
/// Splits flatter than this would leave needles.
constexpr double kLeastRatio = 0.02;
/// A face may turn by the angle with this cosine.
constexpr double kLeastCosine = 0.2;

double distance_from_line(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                          const Eigen::Vector3d& b) {
  const double length = (b - a).norm();
  if (!(length > 0)) return (p - a).norm();
  return (b - a).cross(p - a).norm() / length;
}

}  // namespace

ThinningSurface::ThinningSurface(const Surface& surface)
    : points_(surface.points),
      triangles_(surface.triangles),
      twin_(surface.twin),
      outgoing_(surface.outgoing),
      splitter_({.min_ratio = kLeastRatio, .allow_diagonals = false}) {}

void ThinningSurface::look_at(std::int32_t vertex, Region& region) const {
  region.vertex = vertex;
  region.ring.clear();
  region.faces.clear();
  region.outside.clear();
  const std::int32_t start = outgoing_[vertex];
  std::int32_t h = start;
  std::int32_t last = start;
  do {
    region.ring.push_back(origin(next(h)));
    region.faces.push_back(face_of(h));
    region.outside.push_back(twin_[next(h)]);
    last = h;
    h = twin_[prev(h)];
  } while (h != kNone && h != start);
  region.closed = h != kNone;
  if (!region.closed) {
    region.ring.push_back(origin(prev(last)));
    region.outside.push_back(kNone);
  }

  const Eigen::Vector3d p = points_[vertex].cast<double>();
  const auto n = region.ring.size();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  // relative to the vertex
  region.normal.setZero();
  region.reach = 0;
  Eigen::Vector3d a = points_[region.ring[0]].cast<double>() - p;
  const Eigen::Vector3d first = a;
  for (std::size_t k = 0; k < n; ++k) {
    mean += a / static_cast<double>(n);
    region.reach += a.norm() / static_cast<double>(n);
    if (k + 1 == n && !region.closed) break;
    const Eigen::Vector3d b =
        k + 1 == n ? first : Eigen::Vector3d(points_[region.ring[k + 1]].cast<double>() - p);
    region.normal += a.cross(b);
    a = b;
  }
  const double area = region.normal.norm();
  if (region.closed)
    region.distance = area > 0 ? std::abs(mean.dot(region.normal)) / area : region.reach;
  else
    region.distance = distance_from_line(Eigen::Vector3d::Zero(), first, a);
}

Eigen::Vector3d ThinningSurface::normal(const std::array<std::int32_t, 3>& t) const {
  const Eigen::Vector3d a = points_[t[0]].cast<double>();
  return (points_[t[1]].cast<double>() - a).cross(points_[t[2]].cast<double>() - a);
}

bool ThinningSurface::joined(std::int32_t a, std::int32_t b) const {
  const std::int32_t start = outgoing_[a];
  std::int32_t h = start;
  do {
    if (origin(next(h)) == b || origin(prev(h)) == b) return true;
    h = twin_[prev(h)];
  } while (h != kNone && h != start);
  return false;
}

/// Whether the part and its boundaries survive.
bool ThinningSurface::may_go(const Region& region) const {
  const auto n = region.ring.size();
  if (n < 3 || n > kLargestRing || !(region.normal.squaredNorm() > 0)) return false;
  if (!region.closed) return !joined(region.ring.front(), region.ring.back());
  // The other side of a tetrahedron.
  const auto& outside = region.outside;
  return n > 3 || outside[0] == kNone || outside[1] == kNone ||
         face_of(outside[0]) != face_of(outside[1]);
}

std::span<const std::array<std::int32_t, 3>> ThinningSurface::cover(const Region& region) {
  cover_.clear();
  if (!may_go(region)) return cover_;
  loop_.clear();
  for (const std::int32_t v : region.ring) loop_.push_back(points_[v].cast<double>());
  const auto triangles = splitter_.split(
      loop_,
      [this, &region](std::int32_t a, std::int32_t b) {
        return joined(region.ring[a], region.ring[b]);
      },
      region.normal);
  cover_.assign(triangles.begin(), triangles.end());
  if (!turns_little(region)) cover_.clear();
  for (auto& t : cover_)
    for (std::int32_t& v : t) v = region.ring[v];
  return cover_;
}

/// Whether the cover (of positions in the ring) agrees with the region's normal, and at each edge
/// of the ring with the face that was there.
bool ThinningSurface::turns_little(const Region& region) const {
  const double area = region.normal.norm();
  const auto n = static_cast<std::int32_t>(region.ring.size());
  for (const auto& t : cover_) {
    const Eigen::Vector3d across =
        normal({region.ring[t[0]], region.ring[t[1]], region.ring[t[2]]});
    const double length = across.norm();
    if (!(across.dot(region.normal) >= kLeastCosine * length * area && length > 0)) return false;
    for (int i = 0; i < 3; ++i) {
      const std::int32_t k = t[i];
      if (t[(i + 1) % 3] != (k + 1) % n || (!region.closed && k == n - 1)) continue;
      const Eigen::Vector3d old = normal(triangles_[region.faces[k]]);
      if (!(across.dot(old) >= kLeastCosine * length * old.norm())) return false;
    }
  }
  return true;
}

std::span<const std::int32_t> ThinningSurface::replace(
    const Region& region, std::span<const std::array<std::int32_t, 3>> cover) {
  for (const std::int32_t v : region.ring)
    if (std::find(region.faces.begin(), region.faces.end(), face_of(outgoing_[v])) !=
        region.faces.end())
      outgoing_[v] = kNone;
  for (std::size_t k = 0; k < region.faces.size(); ++k) {
    const std::int32_t f = region.faces[k];
    triangles_[f] = k < cover.size() ? cover[k] : std::array<std::int32_t, 3>{kNone, kNone, kNone};
    for (int i = 0; i < 3; ++i) twin_[halfedge(f, i)] = kNone;
  }
  outgoing_[region.vertex] = kNone;
  link_faces(region, cover);
  return std::span(region.faces).first(cover.size());
}

void ThinningSurface::link_faces(const Region& region,
                                 std::span<const std::array<std::int32_t, 3>> cover) {
  const auto n = region.ring.size();
  const auto halfedge_from = [&](std::int32_t a, std::int32_t b) {
    for (std::size_t k = 0; k < cover.size(); ++k)
      for (int i = 0; i < 3; ++i)
        if (cover[k][i] == a && cover[k][(i + 1) % 3] == b) return halfedge(region.faces[k], i);
    return kNone;
  };
  // Across the ring, ...
  for (std::size_t k = 0; k < n; ++k) {
    if (region.outside[k] == kNone) continue;
    const std::int32_t h = halfedge_from(region.ring[k], region.ring[(k + 1) % n]);
    twin_[h] = region.outside[k];
    twin_[region.outside[k]] = h;
  }
  // ... and inside it.
  for (std::size_t k = 0; k < cover.size(); ++k)
    for (int i = 0; i < 3; ++i) {
      const std::int32_t h = halfedge(region.faces[k], i);
      if (twin_[h] == kNone) twin_[h] = halfedge_from(cover[k][(i + 1) % 3], cover[k][i]);
    }
  for (std::size_t k = 0; k < cover.size(); ++k)
    for (int i = 0; i < 3; ++i) {
      const std::int32_t h = halfedge(region.faces[k], i);
      std::int32_t& chosen = outgoing_[cover[k][i]];
      if (chosen == kNone || twin_[h] == kNone) chosen = h;
    }
}

Surface ThinningSurface::compacted(std::vector<std::int32_t>& source_vertex) const {
  Surface result;
  source_vertex.clear();
  std::vector<std::int32_t> new_vertex(points_.size(), kNone);
  for (std::size_t v = 0; v < points_.size(); ++v) {
    if (outgoing_[v] == kNone) continue;
    new_vertex[v] = static_cast<std::int32_t>(source_vertex.size());
    source_vertex.push_back(static_cast<std::int32_t>(v));
    result.points.push_back(points_[v]);
  }
  std::vector<std::int32_t> new_face(triangles_.size(), kNone);
  for (std::size_t f = 0; f < triangles_.size(); ++f) {
    if (triangles_[f][0] == kNone) continue;
    new_face[f] = static_cast<std::int32_t>(result.triangles.size());
    const auto& t = triangles_[f];
    result.triangles.push_back({new_vertex[t[0]], new_vertex[t[1]], new_vertex[t[2]]});
  }
  result.twin.assign(4 * result.triangles.size(), kNone);
  for (std::size_t f = 0; f < triangles_.size(); ++f)
    for (int i = 0; i < 3 && new_face[f] != kNone; ++i) {
      const std::int32_t t = twin_[halfedge(static_cast<std::int32_t>(f), i)];
      if (t != kNone)
        result.twin[halfedge(new_face[f], i)] = halfedge(new_face[face_of(t)], corner_of(t));
    }
  connect(result);
  return result;
}

}  // namespace semigeo::kernels
