#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/surface/connectivity.hpp"

namespace semigeo::kernels {

/// A point nearer to a corner than this, in barycentric coordinates, is moved onto it
/// (thesis 5.2.3).
inline constexpr float kSnap = 1e-4f;
/// A half-line that has crossed this many faces ends, unless its mesh says otherwise: the mesh is
/// far finer here than its mean edge.
inline constexpr int kMaxCrossings = 400;
/// A half-line ends at a vertex with more faces than this: finding its way round the hub of a fan
/// of 100,000 would cost as much as a whole scan.
inline constexpr int kMaxFan = 1024;

/// What a geodesic needs to know of one face, in one cache line. A point in the face is written in
/// the frame of one of its half-edges h: origin(h) + x (target(h) - origin(h)) + y (apex -
/// origin(h)), where the apex is the third corner; a direction likewise.
struct alignas(64) GeodesicFace {
  /// Unfolding across edge i: the corner opposite to it, written in the frame of the twin half-edge
  /// after this face has been turned into the neighbour's plane (Theorem 6): alpha along the edge,
  /// beta < 0 towards the neighbour's apex.
  struct Edge {
    float alpha;
    float beta;
    std::int32_t twin;
    std::int32_t origin;
  };
  std::array<Edge, 3> edge;
  std::array<float, 3> dot;  ///< of the two edges that leave corner i
  float twice_area;
};

/// Where a geodesic is: a point in a face.
struct FacePoint {
  std::int32_t halfedge = kNone;
  float x = 0;
  float y = 0;
};

/// A point and a direction of unit length, in the frame of `at.halfedge`; (dx, dy) are per unit
/// length. A ray with halfedge kNone goes nowhere.
struct Ray {
  FacePoint at;
  float dx = 0;
  float dy = 0;
};

/// A triangle mesh prepared for geodesics: per face the unfolding coefficients, per vertex position
/// and normal. Lengths are in the units of the points.
struct GeodesicMesh {
  std::span<const GeodesicFace> faces;
  std::span<const std::int32_t> outgoing;    ///< Surface::outgoing
  std::span<const Eigen::Vector4f> points;   ///< fourth component 0
  std::span<const Eigen::Vector3f> normals;  ///< unit, outward; W of (5.1) or better
  int max_crossings = kMaxCrossings;

  const GeodesicFace& face(std::int32_t h) const { return faces[face_of(h)]; }
  std::int32_t origin(std::int32_t h) const { return face(h).edge[corner_of(h)].origin; }
  std::int32_t twin(std::int32_t h) const { return face(h).edge[corner_of(h)].twin; }
  Eigen::Vector3f point(std::int32_t v) const { return points[v].head<3>(); }
};

/// First half of the preparation of face f: connectivity and metric. Needs the points only.
/// Degenerate faces get a small positive area, so that everything stays finite.
void measure_face(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
                  std::int32_t f, GeodesicFace& face);
/// Second half: the unfolding coefficients. Needs `measure_face` of f and its neighbours.
void unfold_face(std::span<GeodesicFace> faces, std::int32_t f);

/// Unit normal at vertex v: the mean of the incident faces' unit normals weighted by the angle at
/// v. Zero if all incident faces are degenerate. Source: thesis (5.1).
Eigen::Vector3f angle_weighted_normal(const Connectivity& surface,
                                      std::span<const Eigen::Vector4f> points, std::int32_t v);

/// The direction of a ray in space, of unit length.
Eigen::Vector3f direction_in_space(const GeodesicMesh& mesh, const Ray& ray);

/// The ray that leaves vertex v along the intersection of the mesh with the normal plane spanned by
/// `direction` (any length > 0) and the vertex normal. kNone if that leads off the surface. Where
/// the plane misses a closed fan, because the surface is folded or a spike, the edge nearest to the
/// direction is taken: a line that ended there would leave half a patch, and the fold for ever.
/// Source: thesis 5.2.2, Theorem 7.
Ray ray_from_vertex(const GeodesicMesh& mesh, std::int32_t v, const Eigen::Vector3f& direction);

/// The two rays at right angles to a ray at its point: `left` is the ray turned by 90 degrees
/// anticlockwise about the outward normal, `right` clockwise. In a face they lie in its plane
/// (Figures 5.8, 5.9); at a vertex each follows the turned normal plane (Figure 5.7).
/// Source: thesis 5.2.4.
struct Perpendiculars {
  Ray left;
  Ray right;
};
Perpendiculars perpendiculars(const GeodesicMesh& mesh, const Ray& ray);

/// The same point with the opposite direction, within the same face.
inline Ray reversed(const Ray& ray) {
  return {ray.at, -ray.dx, -ray.dy};
}

/// Follows a geodesic half-line and hands out its samples.
/// Usage: `GeodesicLine line(mesh, start); while (line.advance(step)) use(line.ray());`
/// Ends (advance is false, for good) at a boundary or after `max_crossings` faces.
/// Source: thesis 5.2.1 - 5.2.3, Theorems 6 and 7.
class GeodesicLine {
 public:
  /// The mesh must outlive the line.
  GeodesicLine(const GeodesicMesh& mesh, const Ray& start);
  GeodesicLine(GeodesicMesh&&, const Ray&) = delete;

  /// Moves on by `length`; false if the line ends before.
  bool advance(float length);

  /// Where the last successful advance ended. Its apex weight grows along the line.
  const Ray& ray() const { return ray_; }

 private:
  const GeodesicMesh& mesh_;
  Ray ray_;
  int crossings_ = 0;
};

}  // namespace semigeo::kernels
