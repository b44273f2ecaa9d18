#include "kernels/repair/vertex_removal.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kernels/surface/circulators.hpp"
#include "kernels/surface/vertex_order.hpp"
#include "kernels/surface/vertex_rows.hpp"

namespace semigeo::kernels {
namespace {

/// The largest number of vertices of a ring. Larger rings would take too much time.
constexpr std::size_t kLargestRing = 40;
/// The least ratio of a split. A smaller one would give triangles like needles.
constexpr double kLeastRatio = 0.02;
/// The cosine of the greatest angle by which a face may turn.
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
      mesh_(surface),
      editor_(mesh_),
      splitter_({.min_ratio = kLeastRatio, .allow_diagonals = false}) {}

void ThinningSurface::examine(std::int32_t vertex, Region& region) const {
  region.vertex = vertex;
  region.closed = !mesh_.on_boundary(vertex);
  region.spokes.clear();
  region.ring.clear();
  for (const std::int32_t h : outgoing(mesh_, vertex)) {
    region.spokes.push_back(h);
    region.ring.push_back(mesh_.target(h));
  }
  if (!region.closed) region.ring.push_back(mesh_.origin(prev(region.spokes.back())));

  const Eigen::Vector3d p = points_[vertex].cast<double>();
  const auto n = region.ring.size();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  // mean of the ring, relative to the vertex
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

Eigen::Vector3d ThinningSurface::normal(const Triangle& t) const {
  const Eigen::Vector3d a = points_[t[0]].cast<double>();
  return (points_[t[1]].cast<double>() - a).cross(points_[t[2]].cast<double>() - a);
}

bool ThinningSurface::joined(std::int32_t a, std::int32_t b) const {
  return find_edge(mesh_, a, b) != kNone;
}

/// Tells whether the removal of the vertex leaves the part and its boundaries in existence.
bool ThinningSurface::is_removable(const Region& region) const {
  const auto n = region.ring.size();
  if (n < 3 || n > kLargestRing || !(region.normal.squaredNorm() > 0)) return false;
  if (!region.closed) return !joined(region.ring.front(), region.ring.back());
  if (n > 3) return true;
  // In a tetrahedron one face lies across all three edges of the ring. It must stay.
  const std::int32_t across = mesh_.twin[next(region.spokes[0])];
  const std::int32_t other = mesh_.twin[next(region.spokes[1])];
  return across == kNone || other == kNone || face_of(across) != face_of(other);
}

std::span<const Triangle> ThinningSurface::cover(const Region& region) {
  cover_.clear();
  if (!is_removable(region)) return cover_;
  loop_.clear();
  for (const std::int32_t v : region.ring) loop_.push_back(points_[v].cast<double>());
  const auto triangles = splitter_.split(
      loop_,
      [this, &region](std::int32_t a, std::int32_t b) {
        return joined(region.ring[a], region.ring[b]);
      },
      region.normal);
  cover_.assign(triangles.begin(), triangles.end());
  if (!faces_keep_direction(region)) cover_.clear();
  for (auto& t : cover_)
    for (std::int32_t& v : t) v = region.ring[v];
  return cover_;
}

/// Tells whether the normals of the cover's faces are near the normal of the region, and, at each
/// edge of the ring, near the normal of the old face. The faces are positions in the ring.
bool ThinningSurface::faces_keep_direction(const Region& region) const {
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
      const Eigen::Vector3d old = normal(mesh_.triangles[face_of(region.spokes[k])]);
      if (!(across.dot(old) >= kLeastCosine * length * old.norm())) return false;
    }
  }
  return true;
}

Surface ThinningSurface::compacted(std::vector<std::int32_t>& source_vertex) const {
  Surface result{kernels::compacted(mesh_, source_vertex), {}, {}, 0};
  result.points = gathered(points_, source_vertex);
  connect(result);
  return result;
}

}  // namespace semigeo::kernels
