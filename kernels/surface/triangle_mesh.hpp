#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace semigeo::kernels {

/// Triangles as a file lists them: indexed, with no promise about topology (a soup is fine).
struct TriangleMesh {
  std::vector<Eigen::Vector3d> points;                 ///< (N, 3), in the scan's length unit
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< (F, 3), indices into points
};

}  // namespace semigeo::kernels
