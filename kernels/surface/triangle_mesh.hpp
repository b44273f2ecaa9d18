#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace semigeo::kernels {

/// Holds triangles as a file lists them: indexed, with no promise about topology. A list of
/// triangles that share no vertices is valid, too.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> points;  ///< (N, 3) Points, in the scan's length unit.
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< (F, 3) Indices into the points.
  /// (N, 3) Normals of the points, of any length, or empty. They tell only which side of an open
  /// surface is outside.
  std::vector<Eigen::Vector3f> normals = {};
};

}  // namespace semigeo::kernels
