#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "io/scans/scan_builder.hpp"

namespace semigeo::io {

/// A type of numbers in a file of VTK.
struct VtkType {
  enum class Kind { kSigned, kUnsigned, kFloat };
  Kind kind = Kind::kFloat;
  int bytes = 4;

  /// Returns the number whose bytes stand at `from`. Whole numbers that are too large for Number
  /// become negative ones.
  template <typename Number>
  Number load_from(const char* from, std::endian order) const;
};

/// Cells whose corners follow each other: cell i has the corners from `begin(i)` to `end(i)`.
struct VtkCells {
  std::vector<std::int64_t> ends;     ///< Where each cell ends among the corners.
  std::vector<std::int64_t> corners;  ///< Indices of points.

  std::int64_t count() const { return static_cast<std::int64_t>(ends.size()); }
  /// Returns the corners of a cell. The ends must have been checked.
  std::span<const std::int64_t> cell(std::int64_t i) const {
    const std::int64_t begin = i == 0 ? 0 : ends[i - 1];
    return std::span(corners).subspan(begin, ends[i] - begin);
  }
  /// Returns the first cell whose end lies before its begin or beyond the corners, or -1.
  std::int64_t first_bad_cell() const;
};

/// Adds a polygon to the scan. `face` is its number in messages.
void add_vtk_polygon(ScanBuilder& builder, std::span<const std::int64_t> corners,
                     std::int64_t face);
/// Adds the triangles of a strip.
void add_vtk_strip(ScanBuilder& builder, std::span<const std::int64_t> corners, std::int64_t face);
/// Counts a vertex or a line, which is no face.
void add_vtk_part(ScanBuilder& builder, std::span<const std::int64_t> corners, std::int64_t face);

}  // namespace semigeo::io
