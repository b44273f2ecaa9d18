#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kernels/surface/surface.hpp"

namespace semigeo::kernels {

/// Describes a closed chain of boundary edges.
struct BoundaryLoop {
  /// A touching point: the copy of a split vertex where the loop goes on.
  struct Join {
    std::int32_t place = 0;   ///< The place in `vertices` of the copy where the loop arrives.
    std::int32_t vertex = 0;  ///< The copy from which it goes on.
  };

  std::vector<std::int32_t> vertices;  ///< In the order in which faces that fill it run.
  std::vector<Join> joins;             ///< A filling makes one vertex of each two copies.
  std::int32_t part = 0;
  double length = 0;   ///< Length of all edges, in the units of the points.
  bool outer = false;  ///< Whether it is the outer boundary of an open part.
};

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

/// Fills a boundary loop by splitting it (see `LoopSplitter`), or, where it crosses itself seen
/// from any side, by `cover_loop`. The result has no triangles if neither is valid. Refined patches
/// are made Delaunay, refined at the centroids of their faces, and moved to where a thin plate
/// would lie that is tied to the faces round the hole (see `fair_plate`). The surface is read near
/// the loop only, and patches of one surface can be made at the same time. The cost is about 15 us
/// for each new vertex; splitting takes 0.1 s for 5,000 edges.
HolePatch make_hole_patch(const Surface& surface, const BoundaryLoop& loop,
                          const HolePatchOptions& options = {});

}  // namespace semigeo::kernels
