#pragma once

#include <cstdint>
#include <vector>

#include "kernels/surface/connectivity.hpp"

namespace semigeo::kernels {

/// Holds triangles over places, together with the vertices that the file gives them. Several
/// vertices of a file may lie at one place.
struct Faces {
  std::vector<Triangle> places;  ///< (F)
  std::vector<Triangle> own;     ///< (F) Vertices of the file; empty if they are the places.

  /// Returns the vertices of the file of face f.
  const Triangle& vertices(std::size_t f) const { return own.empty() ? places[f] : own[f]; }
  /// Turns face f over: its corners 1 and 2 change places.
  void turn_over(std::size_t f);
  /// Removes the faces that are marked (F). Returns their number.
  std::int64_t drop(const std::vector<bool>& marked);
};

/// Drops every face that has two corners at one place. Returns their number.
std::int64_t drop_degenerate(Faces& faces);

/// Drops every face that appeared before: at the same places in the same sense, or with the same
/// vertices of the file. If two faces are left at the same places, back to back, and share a vertex
/// of the file, they are a fold that encloses nothing, and both are dropped. What may be left are
/// two faces, back to back, of surfaces that the file keeps apart. Returns the number of dropped
/// faces. The cost is nearly linear.
std::int64_t drop_duplicates(Faces& faces, std::int64_t vertex_count);

/// Drops sheets that only are the backs of others. `twin` (4 F) tells which faces join. Dropped are
/// connected sets of which every face lies back to back with one of the same set (a two-sided
/// sheet; half of it stays) or, if the set is open, with one of another set that stays. Closed sets
/// that touch others in all of their faces are cells, and stay. Returns the number of dropped
/// faces.
std::int64_t drop_backs(Faces& faces, const std::vector<std::int32_t>& twin,
                        std::int64_t vertex_count);

}  // namespace semigeo::kernels
