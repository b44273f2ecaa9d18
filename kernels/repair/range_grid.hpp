#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace semigeo::kernels {

/// Holds the order in which a scanner measured points: a grid of rays, of which many may have met
/// nothing. The points themselves are kept elsewhere.
struct RangeGrid {
  std::int64_t rows = 0;
  std::int64_t columns = 0;
  /// (rows x columns) Index of the point of each ray, row after row; -1 if nothing was measured.
  std::vector<std::int32_t> cells;
  /// The point from which all rays start. If it is unknown, rays are taken to be parallel.
  std::optional<Eigen::Vector3d> eye;
};

/// The default of `depth_jump` below.
inline constexpr double kDepthJump = 4;

/// Holds the triangles of a grid.
struct GridTriangles {
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< Indices of points.
  std::int64_t jumps = 0;  ///< Number of triangles that were left out at depth jumps.
};

/// Returns the triangles between neighbouring rays. Four rays with points make two triangles, cut
/// along the shorter diagonal; three make one. All triangles have the sense of the grid, which is
/// the one that faces the eye for most of the area. If the eye is unknown, columns run to the right
/// and rows upwards as the scanner sees them, as in the scans of Stanford's repository.
///
/// A triangle is left out if one of its edges is longer than `depth_jump` times the spacing of the
/// grid there, because it would join two surfaces, one before the other. The spacing is the median
/// distance of neighbours, for rows and for columns, and that of a diagonal follows from both. If
/// the eye is known, the spacing grows with the distance from it.
///
/// Indices must be valid and points finite. The cost is linear in the number of rays.
///
/// Source: G. Turk, M. Levoy, Zippered polygon meshes from range images, SIGGRAPH 1994, section 3.
/// Differs: spacing is a median along the surface, and grows with the distance from the eye.
GridTriangles triangulate_grid(const RangeGrid& grid, std::span<const Eigen::Vector3d> points,
                               double depth_jump = kDepthJump);

}  // namespace semigeo::kernels
