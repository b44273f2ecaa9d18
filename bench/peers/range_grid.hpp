#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::peers {

/// Holds a range scan as a scanner sees it: a grid of rays, many of which met nothing.
struct RangeGrid {
  std::int64_t rows = 0;
  std::int64_t columns = 0;
  std::vector<Eigen::Vector3d> points;  ///< Points that were measured.
  /// (rows x columns) Index of the point of each ray, row after row; -1 if nothing was measured.
  std::vector<std::int32_t> cells;
};

/// Reads an ascii PLY with the element `range_grid`, plain or gzip compressed. Rows and columns
/// stand in its header as `obj_info num_rows` and `num_cols`. Throws io::Error if the file cannot
/// be read or is no such PLY.
RangeGrid read_range_grid(const std::filesystem::path& path);

/// Returns the triangles between neighbouring rays. Four rays that met the object give two
/// triangles along the shorter diagonal, three give one. A triangle with an edge that is longer
/// than `longest` times the median distance of neighbours in a row or column is left out: it joins
/// two surfaces, one before the other. Triangles are oriented so that most face towards +z, where
/// the scanner is. All points of the grid are kept.
kernels::TriangleMesh triangulated(const RangeGrid& grid, double longest = 4);

}  // namespace semigeo::peers
