#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "kernels/surface/surface.hpp"
#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::kernels {

/// Counts what had to be changed to make a manifold of the triangles of a file. Nothing is dropped
/// without being counted.
struct SurfaceRepairs {
  std::int64_t welded_vertices = 0;    ///< Merged into an earlier vertex at the same place.
  std::int64_t degenerate_faces = 0;   ///< Dropped: two corners are one vertex.
  std::int64_t duplicate_faces = 0;    ///< Dropped: the same three vertices as an earlier face.
  std::int64_t flipped_faces = 0;      ///< Turned over to agree with their neighbours.
  std::int64_t nonmanifold_faces = 0;  ///< Dropped: an edge already has its two faces.
  std::int64_t split_vertices = 0;     ///< Copies made where fans of faces touch in one vertex.
  std::int64_t isolated_vertices = 0;  ///< Dropped: no face left.

  bool operator==(const SurfaceRepairs&) const = default;
};

/// Holds a surface and what was done to make it one.
struct BuiltSurface {
  Surface surface;                                   ///< Its points are relative to `origin`.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< In the scan's length unit.
  SurfaceRepairs repairs;
};

/// Makes a manifold surface of any triangle list. A scan that lies farther from its coordinate
/// origin than it is large is moved, so that single precision keeps its detail. Identical points
/// are welded, what a half-edge mesh cannot hold is dropped, and neighbours are oriented alike (the
/// majority of each part decides). Vertices and faces keep their order; copies of split vertices
/// come last. The mesh is consumed, to save memory. Indices must be valid and points finite. A
/// result without faces is no error. The cost is linear in memory and, nearly, in time.
BuiltSurface build_surface(TriangleMesh&& mesh);

}  // namespace semigeo::kernels
