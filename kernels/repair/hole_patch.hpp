#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/surface/surface.hpp"

namespace semigeo::kernels {

/// Says how a hole is filled.
struct HolePatchOptions {
  /// Tells whether faces are split until they are about as small as those round the hole, and
  /// continue the surface without a crease. Without it a patch has no vertices of its own.
  bool refine = true;
  /// The approximate largest number of new vertices of a hole. A hole that would take more gets
  /// larger faces away from its rim.
  std::int32_t max_new_vertices = 20000;
};

/// Holds the triangles that fill one hole.
struct HolePatch {
  std::vector<Eigen::Vector3f> points;  ///< New vertices.
  std::vector<Triangle> triangles;      ///< 0 ... n - 1 name the loop, n ... the points.
};

/// Fills the boundary loop `loop` (vertices of the surface, in the order in which the filling faces
/// run along it) by splitting it (see `LoopSplitter`), or, where it crosses itself seen from any
/// side, by `cover_loop`. The result has no triangles if neither is valid. Refined patches are made
/// Delaunay, refined at the centroids of their faces, and moved to where a thin plate would lie
/// that is tied to the faces round the hole (see `fair_plate`). The surface is read near the loop
/// only, and patches of one surface can be made at the same time. The cost is about 15 us for each
/// new vertex; splitting takes 0.1 s for 5,000 edges.
HolePatch make_hole_patch(const Surface& surface, std::span<const std::int32_t> loop,
                          const HolePatchOptions& options = {});

}  // namespace semigeo::kernels
