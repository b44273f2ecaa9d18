#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "kernels/surface/nearest_surface.hpp"
#include "kernels/surface/surface.hpp"

namespace semigeo::kernels {

struct DecimationOptions {
  /// No original vertex may come to lie farther from the result than this, in the units of the
  /// points. Infinity: only the target counts.
  double tolerance = std::numeric_limits<double>::infinity();
  /// Stop at so many vertices. 0: only the tolerance counts.
  std::int64_t target_vertices = 0;
  /// Measure the distance of the original vertices from the result.
  bool measure = true;
};

struct DecimatedSurface {
  Surface surface;                          ///< what is left, in the old order
  std::vector<std::int32_t> source_vertex;  ///< (N) index of each vertex in the input
  std::int64_t removed_vertices = 0;
  std::int64_t removed_faces = 0;
  DistanceSummary distance;  ///< of all original vertices from `surface`: one-sided Hausdorff
};

/// Removes vertices that lie near the average plane of their region (the ring of their neighbours)
/// or, on a boundary, near the line between their neighbours there; nearest first. The hole that a
/// vertex leaves is covered by splitting it (see `LoopSplitter`); where that has no valid split, or
/// would turn a face by more than 78 degrees, the vertex stays. Every removed vertex remembers the
/// face that covers its place, and no later removal may take that farther away than the tolerance:
/// errors do not add up. The result is manifold, has as many parts and boundary loops as the input,
/// and no part falls below a tetrahedron or a triangle. Without a tolerance the removal that moves
/// the surface least comes first. Serial; the result depends on the input alone. Cost: about 3 us a
/// removed vertex, and 2 us to measure it. Source: thesis 5.1.
DecimatedSurface decimate(const Surface& surface, const DecimationOptions& options);

}  // namespace semigeo::kernels
