#pragma once

#include <Eigen/Core>
#include <cstdint>
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

/// Returns the mean length of all edges, each counted once, in the units of the points; 0 without
/// faces.
double mean_edge_length(const Surface& surface);

}  // namespace semigeo::kernels
