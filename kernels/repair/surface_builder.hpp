#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "kernels/surface/surface.hpp"
#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::kernels {

/// Counts what had to be changed to make a manifold of the triangles of a file. Nothing is dropped
/// without being counted.
struct SurfaceRepairs {
  std::int64_t welded_vertices = 0;    ///< Merged into an earlier vertex at the same place.
  std::int64_t gap_vertices = 0;       ///< Merged across gaps that rounding has left.
  std::int64_t degenerate_faces = 0;   ///< Dropped: two corners are one vertex.
  std::int64_t duplicate_faces = 0;    ///< Dropped: the same as an earlier face, or its back.
  std::int64_t flipped_faces = 0;      ///< Turned over to agree with their neighbours.
  std::int64_t nonmanifold_edges = 0;  ///< Cut apart: more than two faces meet there, or a twist.
  std::int64_t turned_parts = 0;       ///< Parts that were inside out.
  std::int64_t split_vertices = 0;     ///< Copies made where fans of faces touch in one vertex.
  std::int64_t isolated_vertices = 0;  ///< Dropped: no face left.

  bool operator==(const SurfaceRepairs&) const = default;
};

/// Says which gaps between triangles are closed. Equal points are welded in any case.
struct Welding {
  /// The two sides of a gap may be so far apart, in the scan's length unit. If it is not given, it
  /// is what the numbers of the file are rounded to (see `rounding_of`); 0: gaps stay.
  std::optional<double> distance = {};
};

/// Holds a surface and what was done to make it one.
struct BuiltSurface {
  Surface surface;                                   ///< Its points are relative to `origin`.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< In the scan's length unit.
  double coordinate_step = 0;  ///< Step of the points' precision, in file or memory.
  double weld_distance = 0;    ///< The two sides of gaps that were closed are no farther apart.
  SurfaceRepairs repairs;
};

/// Makes a manifold surface of any triangle list.
/// - A scan that lies farther from its coordinate origin than it is large is moved, so that single
///   precision keeps its detail. Vertices that no face uses do not count.
/// - Identical points are welded, and gaps that `welding` allows are closed.
/// - Only degenerate and duplicate faces are dropped. Where more than two faces meet in an edge, or
///   fans touch in a vertex, surfaces are cut apart (see `pair_edges`). Solids that touch in a face
///   keep it both.
/// - Neighbours are oriented alike, closed parts outwards, and open ones as the normals of the mesh
///   say, if it has any (see `turn_inverted_parts`).
///
/// Vertices and faces keep their order; copies of split vertices come last. The mesh is consumed,
/// to save memory. Indices must be valid and points finite. A result without faces is no error. The
/// cost is linear in memory and, nearly, in time.
BuiltSurface build_surface(TriangleMesh&& mesh, const Welding& welding = {});

}  // namespace semigeo::kernels
