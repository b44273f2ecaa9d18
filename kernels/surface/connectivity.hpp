#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace semigeo::kernels {

/// The index that stands for "none": no half-edge, no vertex, no face.
inline constexpr std::int32_t kNone = -1;

/// The corners of a face, anticlockwise, as indices of vertices or points.
using Triangle = std::array<std::int32_t, 3>;

/// Returns half-edge 4 f + i, which runs from corner i to corner i + 1 of face f. Slot 3 of each
/// face is unused, so that stepping round a face needs no division.
constexpr std::int32_t halfedge(std::int32_t face, int corner) {
  return 4 * face + corner;
}
/// Returns the face to which a half-edge belongs.
constexpr std::int32_t face_of(std::int32_t h) {
  return h >> 2;
}
/// Returns the corner, 0 to 2, at which a half-edge starts in its face.
constexpr int corner_of(std::int32_t h) {
  return h & 3;
}
/// Returns the half-edge that follows h in its face, anticlockwise.
constexpr std::int32_t next(std::int32_t h) {
  return (h & ~3) | ((0b001001 >> (2 * (h & 3))) & 3);
}
/// Returns the half-edge that comes before h in its face.
constexpr std::int32_t prev(std::int32_t h) {
  return (h & ~3) | ((0b010010 >> (2 * (h & 3))) & 3);
}

/// The half-edges of an oriented two-manifold triangle mesh, open or closed, as flat arrays. Every
/// directed edge belongs to at most one face, and the faces round a vertex form one fan.
struct Connectivity {
  std::vector<Triangle> triangles;  ///< (F, 3) Vertices, anticlockwise seen from outside.
  std::vector<std::int32_t> twin;   ///< (4 F) Opposite half-edge, or kNone on a boundary.
  /// (N) A half-edge that starts at the vertex. On a boundary it is the one without a twin, so that
  /// `ccw` visits the whole fan.
  std::vector<std::int32_t> outgoing;

  std::int64_t vertex_count() const { return static_cast<std::int64_t>(outgoing.size()); }
  std::int64_t face_count() const { return static_cast<std::int64_t>(triangles.size()); }

  /// Returns the vertex at which half-edge h starts.
  std::int32_t origin(std::int32_t h) const { return triangles[face_of(h)][corner_of(h)]; }
  /// Returns the vertex at which half-edge h ends.
  std::int32_t target(std::int32_t h) const { return origin(next(h)); }
  /// Returns the next half-edge anticlockwise round the origin of h, or kNone past a boundary.
  std::int32_t ccw(std::int32_t h) const { return twin[prev(h)]; }
  /// Returns whether a vertex lies on a boundary.
  bool on_boundary(std::int32_t vertex) const { return twin[outgoing[vertex]] == kNone; }
};

/// Fills `outgoing` from triangles and twins. Every vertex below `vertex_count` must have a face.
/// The cost is linear.
void choose_outgoing(Connectivity& mesh, std::int64_t vertex_count);

/// Returns the connectivity of triangles over `vertex_count` vertices. The triangles must be
/// manifold and oriented alike, with one fan of faces at each vertex. The cost is linear.
Connectivity connect(std::vector<Triangle> triangles, std::int64_t vertex_count);

/// Finds the edge between two vertices. Returns it as the half-edge in either direction, or kNone
/// where there is none. The cost is linear in the smaller fan.
std::int32_t find_edge(const Connectivity& mesh, std::int32_t a, std::int32_t b);

/// Fills `part` (N) with the number of the connected part of each vertex; parts are numbered by
/// their first vertex. Returns the number of parts. The cost is linear.
std::int32_t number_parts(const Connectivity& mesh, std::vector<std::int32_t>& part);

}  // namespace semigeo::kernels
