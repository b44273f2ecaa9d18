#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/patch/geodesic_limits.hpp"
#include "kernels/surface/connectivity.hpp"

namespace semigeo::kernels {

/// Holds what a geodesic needs to know of one face, in one cache line. A point in the face is
/// written in the frame of one of its half-edges h, as origin(h) + x (target(h) - origin(h)) + y
/// (apex - origin(h)), where the apex is the third corner. A direction is written in the same
/// frame.
struct alignas(64) GeodesicFace {
  /// Describes the unfolding across edge i: the corner opposite to it, written in the frame of the
  /// twin half-edge after this face has been turned into the plane of its neighbour (Theorem 6).
  /// alpha is the share along the edge, beta < 0 the share towards the neighbour's apex.
  struct Edge {
    float alpha;
    float beta;
    std::int32_t twin;
    std::int32_t origin;
  };
  std::array<Edge, 3> edge;
  std::array<float, 3> dot;  ///< Scalar product of the two edges that leave corner i.
  float twice_area;
};

/// Describes a point in a face, in the frame of a half-edge.
struct FacePoint {
  std::int32_t halfedge = kNone;
  float x = 0;
  float y = 0;
};

/// Describes a point and a direction in the frame of `at.halfedge`; (dx, dy) is the change per unit
/// length. A ray with half-edge kNone leads nowhere.
struct Ray {
  FacePoint at;
  float dx = 0;
  float dy = 0;
};

/// Describes a triangle mesh that is prepared for geodesics: each face has its unfolding
/// coefficients, each vertex its position and normal. Lengths are in the units of the points.
struct GeodesicMesh {
  std::span<const GeodesicFace> faces;
  std::span<const std::int32_t> outgoing;    ///< Connectivity::outgoing.
  std::span<const Eigen::Vector4f> points;   ///< The fourth component is 0.
  std::span<const Eigen::Vector3f> normals;  ///< Of unit length, outward; W of (5.1) or better.
  int max_crossings = kMaxCrossings;

  const GeodesicFace& face(std::int32_t h) const { return faces[face_of(h)]; }
  std::int32_t origin(std::int32_t h) const { return face(h).edge[corner_of(h)].origin; }
  std::int32_t twin(std::int32_t h) const { return face(h).edge[corner_of(h)].twin; }
  Eigen::Vector3f point(std::int32_t v) const { return points[v].head<3>(); }
};

/// Fills the first half of face f: connectivity and metric. Degenerate faces get a small positive
/// area, so that everything stays finite.
void measure_face(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
                  std::int32_t f, GeodesicFace& face);
/// Fills the second half of face f: the unfolding coefficients. `measure_face` of the face and its
/// neighbours must come before.
void unfold_face(std::span<GeodesicFace> faces, std::int32_t f);

/// Returns the unit normal at vertex v: the mean of the unit normals of its faces, weighted by
/// their angles at v. It is zero if all these faces are degenerate. Source: thesis (5.1).
Eigen::Vector3f angle_weighted_normal(const Connectivity& surface,
                                      std::span<const Eigen::Vector4f> points, std::int32_t v);

/// Returns the direction of a ray in space, of unit length.
Eigen::Vector3f direction_in_space(const GeodesicMesh& mesh, const Ray& ray);

/// Returns the ray that leaves vertex v along the intersection of the mesh with the normal plane,
/// which is spanned by `direction` (any length > 0) and the vertex normal. Its half-edge is kNone
/// if that leads off the surface. Where the plane misses a closed fan, because the surface is
/// folded or a spike, the edge nearest to the direction is taken: a line that ended there would
/// leave half a patch, and smoothing would never remove the fold. Source: thesis 5.2.2, Theorem 7.
Ray ray_from_vertex(const GeodesicMesh& mesh, std::int32_t v, const Eigen::Vector3f& direction);

/// Holds the two rays at right angles to a ray at its point.
struct Perpendiculars {
  Ray left;   ///< Turned by 90 degrees anticlockwise about the outward normal.
  Ray right;  ///< Turned by 90 degrees clockwise.
};
/// Returns the two rays at right angles to a ray. In a face they lie in its plane
/// (Figures 5.8, 5.9); at a vertex each follows the turned normal plane (Figure 5.7). Source:
/// thesis 5.2.4.
Perpendiculars perpendiculars(const GeodesicMesh& mesh, const Ray& ray);

/// Returns the ray with the same point and the opposite direction, within the same face.
inline Ray reversed(const Ray& ray) {
  return {ray.at, -ray.dx, -ray.dy};
}

/// Follows a geodesic half-line and hands out its samples:
/// `GeodesicLine line(mesh, start); while (line.advance(step)) use(line.ray());`
/// The line ends at a boundary or after `max_crossings` faces; then `advance` stays false.
/// Source: thesis 5.2.1 - 5.2.3, Theorems 6 and 7.
class GeodesicLine {
 public:
  /// The mesh must outlive the line.
  GeodesicLine(const GeodesicMesh& mesh, const Ray& start);
  GeodesicLine(GeodesicMesh&&, const Ray&) = delete;

  /// Moves on by `length`. Returns false if the line ends before that.
  bool advance(float length);

  /// Returns where the last successful advance ended. Its apex weight y grows along the line.
  const Ray& ray() const { return ray_; }

 private:
  const GeodesicMesh& mesh_;
  Ray ray_;
  int crossings_ = 0;
};

}  // namespace semigeo::kernels
