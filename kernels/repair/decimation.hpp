#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "kernels/surface/nearest_surface.hpp"
#include "kernels/surface/surface.hpp"

namespace semigeo::kernels {

/// Says how far a surface is decimated.
struct DecimationOptions {
  /// The greatest distance that an original vertex may have from the result, in the units of the
  /// points. With infinity only the target counts.
  double tolerance = std::numeric_limits<double>::infinity();
  /// The number of vertices at which decimation stops. With 0 only the tolerance counts.
  std::int64_t target_vertices = 0;
  /// Tells whether to measure the distance of the original vertices from the result.
  bool measure = true;
};

/// Holds a decimated surface and what was removed.
struct DecimatedSurface {
  Surface surface;                          ///< What is left, in the old order.
  std::vector<std::int32_t> source_vertex;  ///< (N) Index of each vertex in the input.
  std::int64_t removed_vertices = 0;
  std::int64_t removed_faces = 0;
  DistanceSummary distance;  ///< Distances of all original vertices from `surface`.
};

/// Removes vertices that lie near the average plane of their region (the ring of their neighbours)
/// or, on a boundary, near the line between their neighbours there; the nearest come first. The
/// hole that a vertex leaves is covered by splitting its loop (see `LoopSplitter`). Where the loop
/// has no valid split, or a face would turn by more than 78 degrees, the vertex stays. Every
/// removed vertex remembers the face that covers its place, and no later removal may take that face
/// farther away than the tolerance, so errors do not add up. The result is manifold, has as many
/// parts and boundary loops as the input, and no part falls below a tetrahedron or a triangle.
/// Without a tolerance the removal that moves the surface least comes first. The function is
/// serial, and the result depends on the input alone. The cost is about 3 us a removed vertex, and
/// 2 us to measure it. Source: thesis 5.1.
DecimatedSurface decimate(const Surface& surface, const DecimationOptions& options);

}  // namespace semigeo::kernels
