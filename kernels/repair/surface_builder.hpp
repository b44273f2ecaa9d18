#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "kernels/surface/surface.hpp"
#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::kernels {

/// What had to be changed to make a manifold of the triangles of a file. Nothing is dropped
/// silently.
struct SurfaceRepairs {
  std::int64_t welded_vertices = 0;    ///< merged into an earlier vertex at the same place
  std::int64_t degenerate_faces = 0;   ///< dropped: two corners are one vertex
  std::int64_t duplicate_faces = 0;    ///< dropped: the same three vertices as an earlier face
  std::int64_t flipped_faces = 0;      ///< turned over to agree with their neighbours
  std::int64_t nonmanifold_faces = 0;  ///< dropped: an edge already has its two faces
  std::int64_t split_vertices = 0;     ///< copies made where fans of faces touch in one vertex only
  std::int64_t isolated_vertices = 0;  ///< dropped: no face left

  bool operator==(const SurfaceRepairs&) const = default;
};

struct BuiltSurface {
  Surface surface;                                   ///< points relative to `origin`
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< in the scan's length unit
  SurfaceRepairs repairs;
};

/// Makes a manifold surface of any triangle list: moves a scan that lies farther from its
/// coordinate origin than it is large (so that single precision keeps its detail), welds identical
/// points, drops what a half-edge mesh cannot hold, orients neighbours alike (the majority of each
/// part decides) and connects. Vertices and faces keep their order; copies of split vertices come
/// last. The mesh is consumed, to save memory. Indices must be valid and points finite. Not an
/// error: an empty result (no face left). Cost: linear in memory and, nearly, in time.
BuiltSurface build_surface(TriangleMesh&& mesh);

}  // namespace semigeo::kernels
