#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kernels/surface/connectivity.hpp"

namespace semigeo::kernels {

/// Holds triangles that cover a loop.
struct LoopCover {
  std::vector<Triangle> triangles;  ///< Indices into the loop, running along it.
  double area = 0;                  ///< Area of all triangles.
  double folded_area = 0;           ///< Area of the smaller of any two folded neighbours.
};

/// The share of its area by which a cover may lie folded on itself. With more it is no cover: a
/// figure of eight has no inside.
inline constexpr double kMostFolded = 0.05;

/// Covers a closed loop of n >= 3 points with the n - 2 triangles that have the least sum of area
/// and bending, wherever it runs in space. It is meant for loops that cross themselves seen from
/// any side, so that no plane splits them. `normals[k]` is the unit normal of the face across the
/// edge k, k + 1, or zero if that is not known. Two vertices that are `joined` are not joined
/// again. The result has no triangles if no cover exists. Time grows as n^3 (n = 100: 4 ms), memory
/// as n^2.
LoopCover cover_loop(std::span<const Eigen::Vector3d> loop,
                     std::span<const Eigen::Vector3d> normals,
                     const std::function<bool(std::int32_t, std::int32_t)>& joined);

}  // namespace semigeo::kernels
