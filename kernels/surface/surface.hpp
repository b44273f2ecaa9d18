#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace semigeo::kernels {

/// Marks a half-edge without a face on its other side.
inline constexpr std::int32_t kNone = -1;

/// Half-edge h = 4 f + i runs from corner i to corner i + 1 of face f; slot 3 of each face is
/// unused, so that stepping round a face needs no division.
constexpr std::int32_t halfedge(std::int32_t face, int corner) {
  return 4 * face + corner;
}
constexpr std::int32_t face_of(std::int32_t h) {
  return h >> 2;
}
constexpr int corner_of(std::int32_t h) {
  return h & 3;
}
constexpr std::int32_t next(std::int32_t h) {
  return (h & ~3) | ((0b001001 >> (2 * (h & 3))) & 3);
}
constexpr std::int32_t prev(std::int32_t h) {
  return (h & ~3) | ((0b010010 >> (2 * (h & 3))) & 3);
}

/// An oriented two-manifold triangle mesh, open or closed, as flat arrays. Connectivity only grows
/// out of `build_surface`, which guarantees: every directed edge belongs to at most one face, and
/// the faces round a vertex form one fan.
struct Surface {
  std::vector<Eigen::Vector3f> points;                 ///< (N, 3)
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< (F, 3), anticlockwise seen from outside
  std::vector<std::int32_t> twin;                      ///< (4 F) opposite half-edge or kNone
  std::vector<std::int32_t> outgoing;  ///< (N) a half-edge that starts here; on a boundary the one
                                       ///< without a twin, so that `ccw` visits the whole fan
  std::vector<std::int32_t> part;      ///< (N) connected part, numbered by first vertex
  std::int32_t part_count = 0;

  std::int64_t vertex_count() const { return static_cast<std::int64_t>(points.size()); }
  std::int64_t face_count() const { return static_cast<std::int64_t>(triangles.size()); }

  std::int32_t origin(std::int32_t h) const { return triangles[face_of(h)][corner_of(h)]; }
  std::int32_t target(std::int32_t h) const { return origin(next(h)); }
  /// The next half-edge anticlockwise round the origin of h, or kNone past a boundary.
  std::int32_t ccw(std::int32_t h) const { return twin[prev(h)]; }
  bool on_boundary(std::int32_t vertex) const { return twin[outgoing[vertex]] == kNone; }
};

/// Fills `outgoing`, `part` and `part_count` of a surface whose points, triangles and twins are
/// set. The triangles must be manifold and oriented alike, with one fan of faces at each vertex.
/// Linear cost.
void connect(Surface& surface);

/// Fills `part` and `part_count` anew from the rest. Linear cost.
void number_parts(Surface& surface);

/// Mean length of all edges, each counted once, in the units of the points; 0 without faces.
double mean_edge_length(const Surface& surface);

}  // namespace semigeo::kernels
