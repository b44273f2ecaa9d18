#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/surface/connectivity.hpp"

namespace semigeo::kernels {

/// Edits a connectivity in place. Everything that kernels/surface/connectivity.hpp promises holds
/// after every call. Vertices and faces keep their numbers; those that are removed leave gaps
/// (`outgoing` and the corners of a face are kNone). New faces fill gaps or come last, new vertices
/// come last. The caller takes care of points and parts. The cost of a call is linear in the
/// smallest fans involved. One editor serves one thread.
class SurfaceEditor {
 public:
  /// The mesh must outlive the editor.
  explicit SurfaceEditor(Connectivity& mesh);

  /// The vertices that a new one comes from; kNone where there are fewer. A vertex with one is its
  /// copy, a vertex with two lies half way between them, a vertex with three at their centroid.
  struct Birth {
    std::int32_t first = kNone;
    std::int32_t second = kNone;
    std::int32_t third = kNone;
  };

  /// Returns whether a face was not removed.
  bool has_face(std::int32_t f) const { return mesh_.triangles[f][0] != kNone; }
  /// Returns whether a vertex was not removed.
  bool has_vertex(std::int32_t v) const { return mesh_.outgoing[v] != kNone; }
  /// Returns the number of faces that are left.
  std::int64_t face_count() const { return face_count_; }
  /// Returns the number of vertices that are left.
  std::int64_t vertex_count() const { return vertex_count_; }
  /// Returns where each vertex comes from that this editor has made, in the order of their numbers.
  const std::vector<Birth>& births() const { return births_; }

  /// The reasons that prevent the collapse of an edge.
  enum class Obstacle {
    kNothing,
    kCycle,  ///< Both ends have a common neighbour across no face: a neck, a hole of three edges.
    kChord,  ///< The edge joins two boundary vertices through the surface: a strip.
    kPart    ///< The connected part of the edge is a triangle or a tetrahedron.
  };
  /// Tells whether an edge can collapse.
  struct Collapse {
    Obstacle obstacle = Obstacle::kNothing;
    std::int32_t third = kNone;  ///< The common neighbour of a cycle.
  };
  /// Tells whether the ends of half-edge h can become one vertex: the link condition. The check
  /// costs least if the target has the smaller fan.
  Collapse may_collapse(std::int32_t h) const;

  /// Returns the half-edge of the same edge whose origin has the larger fan; h itself on a
  /// boundary.
  std::int32_t from_larger_fan(std::int32_t h) const;

  /// Returns the end that stays when half-edge h collapses: its origin, or, on a boundary, where h
  /// has no opposite to choose, the end with the larger fan.
  std::int32_t survivor(std::int32_t h) const;

  /// Makes one vertex, `survivor`, of the ends of h. `may_collapse` must allow it.
  void collapse(std::int32_t h);

  /// Tells whether the edge of half-edge h may become the other diagonal of its two faces: it has
  /// two faces, and no edge joins their far corners yet.
  bool may_flip(std::int32_t h) const;
  /// Turns the edge of half-edge h to the other diagonal of its two faces. Returns the new edge, as
  /// half-edge 1 of the face of h.
  std::int32_t flip(std::int32_t h);

  /// Cuts along the three edges between a, b and c, and covers either side of the cut with a face.
  /// The vertices are doubled, so that a neck parts and a handle opens; a hole of three edges is
  /// closed. Returns the two covers; kNone where one side had no faces.
  std::array<std::int32_t, 2> cut_cycle(std::int32_t a, std::int32_t b, std::int32_t c);

  /// Cuts along an edge whose ends both lie on a boundary, and doubles them.
  void cut_chord(std::int32_t h);

  /// Halves an edge and the faces on both sides. Returns the new vertex.
  std::int32_t split(std::int32_t h);

  /// Splits face (a, b, c) at a new vertex v into (a, b, v), which keeps the slot of the face,
  /// (b, c, v) and (c, a, v). Returns the new vertex.
  std::int32_t split_face(std::int32_t face);

  /// Removes vertex v and covers its place: face k of the cover takes the slot of the k-th face
  /// that `outgoing` visits round v. The cover must have the outline of those faces and at most as
  /// many faces, and must not join vertices that an edge joins already.
  void remove_vertex(std::int32_t v, std::span<const Triangle> cover);

  /// Counts what was removed.
  struct Dropped {
    std::int64_t vertices = 0;
    std::int64_t faces = 0;
  };
  /// Removes a face and all that is connected to it. Returns how much that was.
  Dropped drop_part(std::int32_t face);

 private:
  /// A face round a vertex that is removed: the edge that does not touch the vertex.
  struct FanFace {
    std::int32_t face;
    std::int32_t from;
    std::int32_t to;
    std::int32_t across;  ///< The half-edge on the other side of the edge, or kNone.
  };

  bool larger_fan(std::int32_t a, std::int32_t b) const;
  void unite(std::int32_t h, std::int32_t other);
  void move_fan(std::int32_t first, std::int32_t vertex);
  std::int32_t fold(std::int32_t gone, std::int32_t into, std::int32_t from);
  std::int32_t first_after_collapse(std::int32_t h) const;
  void remove_face(std::int32_t f);
  std::int32_t add_face(const Triangle& corners);
  std::int32_t add_vertex(const Birth& birth);
  void separate_fans(std::int32_t v, std::span<const std::int32_t> starts);
  void link_cover(std::span<const Triangle> cover);

  Connectivity& mesh_;
  std::vector<std::int32_t> free_faces_;
  std::vector<Birth> births_;
  std::vector<FanFace> fan_;  ///< Working memory of `remove_vertex`.
  std::int64_t face_count_;
  std::int64_t vertex_count_;
};

}  // namespace semigeo::kernels
