#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/surface/surface.hpp"

namespace semigeo::kernels {

/// Edits the connectivity of a surface in place. What a surface promises
/// (kernels/surface/surface.hpp) holds after every call, except for `part`, which is not kept up,
/// and for numbers: vertices and faces keep theirs, those that are removed leave gaps (`outgoing`
/// and corner 0 are kNone), new faces fill gaps or come last, new vertices come last. Points are
/// neither read nor written. Costs are linear in the smallest fans involved.
class SurfaceEditor {
 public:
  /// The surface must outlive the editor.
  explicit SurfaceEditor(Surface& surface);

  /// Where a new vertex comes from: half way between two others, or a copy of `first`.
  struct Birth {
    std::int32_t first = kNone;
    std::int32_t second = kNone;
  };

  bool has_face(std::int32_t f) const { return surface_.triangles[f][0] != kNone; }
  bool has_vertex(std::int32_t v) const { return surface_.outgoing[v] != kNone; }
  std::int64_t face_count() const { return face_count_; }
  std::int64_t vertex_count() const { return vertex_count_; }
  const std::vector<Birth>& births() const { return births_; }

  /// Why an edge cannot be collapsed.
  enum class Obstacle {
    none,
    cycle,  ///< both ends have a neighbour in common across no face: a neck, a hole of three edges
    chord,  ///< the edge joins two boundary vertices through the surface: a strip
    part    ///< its part is a triangle or a tetrahedron
  };
  struct Collapse {
    Obstacle obstacle = Obstacle::none;
    std::int32_t third = kNone;  ///< of the cycle
  };
  /// Whether the ends of half-edge h can become one vertex: the link condition. Cheapest if the
  /// target has the smaller fan.
  Collapse may_collapse(std::int32_t h) const;

  /// The half-edge of the same edge whose origin has the larger fan; h itself on a boundary.
  std::int32_t from_larger_fan(std::int32_t h) const;

  /// Which end stays when half-edge h collapses: its origin; on a boundary, where h has no opposite
  /// to choose, the end with the larger fan.
  std::int32_t survivor(std::int32_t h) const;

  /// Makes the ends of h one, at `survivor`. `may_collapse` must allow it.
  void collapse(std::int32_t h);

  /// Whether the edge of half-edge h may be turned to the other diagonal of its two faces: it has
  /// two, and no edge joins their far corners yet.
  bool may_flip(std::int32_t h) const;
  /// Does it. result: the new edge.
  std::int32_t flip(std::int32_t h);

  /// Cuts along the three edges between a, b and c, and covers what was on either side of the cut
  /// with a face. The vertices are doubled, so that a neck parts and a handle opens; a hole of
  /// three edges is closed. result: the two covers; kNone where one side had no faces.
  std::array<std::int32_t, 2> cut_cycle(std::int32_t a, std::int32_t b, std::int32_t c);

  /// Cuts along an edge whose ends both lie on a boundary, and doubles them.
  void cut_chord(std::int32_t h);

  /// Halves an edge and the faces on both sides. result: the new vertex.
  std::int32_t split(std::int32_t h);

  /// Removes a face and all that is connected to it. result: vertices removed.
  struct Dropped {
    std::int64_t vertices = 0;
    std::int64_t faces = 0;
  };
  Dropped drop_part(std::int32_t face);

  /// Calls visit(half-edge) for each face round v, with the half-edge that leaves v.
  template <typename Visit>
  void each_corner(std::int32_t v, const Visit& visit) const {
    const std::int32_t start = surface_.outgoing[v];
    std::int32_t h = start;
    do {
      visit(h);
      h = surface_.ccw(h);
    } while (h != kNone && h != start);
  }

 private:
  bool larger_fan(std::int32_t a, std::int32_t b) const;
  std::int32_t between(std::int32_t a, std::int32_t b) const;
  void unite(std::int32_t h, std::int32_t other);
  std::int32_t fold(std::int32_t gone, std::int32_t into, std::int32_t from);
  std::int32_t first_after_collapse(std::int32_t h) const;
  void remove_face(std::int32_t f);
  std::int32_t add_face(const std::array<std::int32_t, 3>& corners);
  std::int32_t add_vertex(const Birth& birth);
  void separate_fans(std::int32_t v, std::span<const std::int32_t> starts);

  Surface& surface_;
  std::vector<std::int32_t> free_faces_;
  std::vector<Birth> births_;
  std::int64_t face_count_;
  std::int64_t vertex_count_;
};

}  // namespace semigeo::kernels
