#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::tests {

/// Six times the volume of a tetrahedron, zero if no more than rounding.
inline double signed_volume(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                            const Eigen::Vector3d& c, const Eigen::Vector3d& d) {
  const Eigen::Vector3d u = b - a, v = c - a, w = d - a;
  const double volume = u.cross(v).dot(w);
  const double size = u.norm() * v.norm() * w.norm();
  return std::abs(volume) > 1e-12 * size ? volume : 0;
}

/// Whether the segment passes from one side of the triangle to the other through its inside.
inline bool pierces(const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                    const std::array<Eigen::Vector3d, 3>& t) {
  if (signed_volume(p, t[0], t[1], t[2]) * signed_volume(q, t[0], t[1], t[2]) >= 0) return false;
  const double a = signed_volume(p, q, t[0], t[1]), b = signed_volume(p, q, t[1], t[2]),
               c = signed_volume(p, q, t[2], t[0]);
  return (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
}

/// How many pairs of triangles without a common vertex pass through each other. Touching is not
/// enough: where a surface has just been cut, both covers lie in one place. Cost: n log n, and
/// n times the triangles that overlap one in x.
inline std::int64_t count_intersections(const kernels::TriangleMesh& mesh) {
  using Corners = std::array<Eigen::Vector3d, 3>;
  const std::size_t n = mesh.triangles.size();
  std::vector<Corners> corners(n);
  std::vector<Eigen::AlignedBox3d> boxes(n);
  for (std::size_t f = 0; f < n; ++f)
    for (int i = 0; i < 3; ++i) {
      corners[f][i] = mesh.points[mesh.triangles[f][i]];
      boxes[f].extend(corners[f][i]);
    }
  const auto any_pierces = [](const Corners& a, const Corners& b) {
    return pierces(a[0], a[1], b) || pierces(a[1], a[2], b) || pierces(a[2], a[0], b);
  };
  const auto share_vertex = [&](std::size_t f, std::size_t g) {
    return std::ranges::find_first_of(mesh.triangles[f], mesh.triangles[g]) !=
           mesh.triangles[f].end();
  };
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](std::size_t f) { return boxes[f].min().x(); });
  std::int64_t count = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      const std::size_t f = order[i], g = order[j];
      if (boxes[g].min().x() > boxes[f].max().x()) break;
      if (boxes[f].intersects(boxes[g]) && !share_vertex(f, g))
        count += any_pierces(corners[f], corners[g]) || any_pierces(corners[g], corners[f]);
    }
  return count;
}

}  // namespace semigeo::tests
