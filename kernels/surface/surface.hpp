#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "kernels/surface/connectivity.hpp"

namespace semigeo::kernels {

/// A triangle mesh with points and connected parts. `build_surface` makes one from any triangles.
struct Surface : Connectivity {
  std::vector<Eigen::Vector3f> points;  ///< (N, 3) Points, in the scan's length unit.
  std::vector<std::int32_t> part;       ///< (N) Connected part, numbered by first vertex.
  std::int32_t part_count = 0;
};

/// Fills `outgoing`, `part` and `part_count` of a surface whose points, triangles and twins are
/// set. The triangles must be manifold and oriented alike, with one fan of faces at each vertex.
/// The cost is linear.
void connect(Surface& surface);

/// Says how long the edges of a surface are, in the units of its points.
struct EdgeLengths {
  double mean = 0;  ///< Mean length of all edges but outliers, each counted once; 0 without faces.
  /// Longer edges are outliers; infinity if there are none.
  double limit = std::numeric_limits<double>::infinity();
};

/// Returns the mean length of the edges. Edges longer than 20 times the median are outliers and do
/// not count, unless they are more than a tenth of all edges: then they are how this mesh is made.
/// A vertex far out, pixels of a range image without depth, or a few huge faces therefore do not
/// change the result; without outliers it is the plain mean. The cost is linear.
EdgeLengths edge_lengths(const Surface& surface);

/// Returns the mean of `edge_lengths`.
inline double mean_edge_length(const Surface& surface) {
  return edge_lengths(surface).mean;
}

}  // namespace semigeo::kernels
