#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

namespace semigeo::kernels {

/// Describes a face as a quadratic surface over its barycentric coordinates w:
/// sum w_i p_i + sum over edges w_i w_j bulge_ij. The middle of an edge is lifted off the chord by
/// a quarter of its bulge, onto the surface that the corner normals describe.
struct QuadraticFace {
  std::array<Eigen::Vector3f, 3> bulge;  ///< [i]: edge from corner i to i + 1.
};

/// Returns the bulge of the edge between points p and q with unit normals m and n there. It is
/// exact to second order for any smooth surface with its true normals; symmetric in the two ends,
/// so that faces join without gaps; and not longer than the edge. Zero normals give a straight
/// edge. Differs: the thesis samples flat triangles, which lie inside the surface by as much as
/// curvature moves it, and so overestimate K by 5 % at any resolution.
inline Eigen::Vector3f edge_bulge(const Eigen::Vector3f& p, const Eigen::Vector3f& q,
                                  const Eigen::Vector3f& m, const Eigen::Vector3f& n) {
  const Eigen::Vector3f edge = q - p;
  return 0.5f * (edge.dot(n) * n - edge.dot(m) * m);
}

}  // namespace semigeo::kernels
