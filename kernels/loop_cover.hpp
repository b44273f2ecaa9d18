#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace semigeo::kernels {

/// Covers a closed loop of n >= 3 points with the n - 2 triangles that have the least sum of area
/// and bending, wherever it runs in space: for loops that cross themselves seen from any side, so
/// that no plane splits them. `normals[k]` is the unit normal of the face across the edge k, k + 1;
/// the triangles run along the loop. Two vertices that are `joined` are not joined again. Nothing
/// if no cover exists or if more than 5 % of its area lies folded back on itself, as a figure of
/// eight would. Time grows as n^3 (n = 100: 4 ms), memory as n^2.
std::vector<std::array<std::int32_t, 3>> cover_loop(
    std::span<const Eigen::Vector3d> loop, std::span<const Eigen::Vector3d> normals,
    const std::function<bool(std::int32_t, std::int32_t)>& joined);

}  // namespace semigeo::kernels
