#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "io/files/byte_source.hpp"

namespace semigeo::io {

/// A value, or several values of one type, that each point of a PCD has.
struct PcdField {
  std::string name;
  std::int64_t size = 4;    ///< Bytes of a value.
  char type = 'F';          ///< 'F' for floating-point numbers, 'I' and 'U' for integers.
  std::int64_t count = 1;   ///< Number of values.
  std::int64_t offset = 0;  ///< Bytes of the fields before it.
  std::int64_t column = 0;  ///< Values of the fields before it.
};

/// Holds the header of a PCD.
struct PcdHeader {
  /// The encoding of the data behind the header.
  enum class Encoding { kAscii, kBinary, kCompressed };
  Encoding encoding = Encoding::kAscii;
  std::vector<PcdField> fields;
  std::array<std::int64_t, 3> axes = {-1, -1, -1};  ///< Indices of the fields x, y and z.
  std::int64_t width = 0;                           ///< Number of columns of the grid.
  std::int64_t height = 0;                          ///< Number of rows of the grid.
  std::int64_t point_bytes = 0;                     ///< Bytes of a point in binary data.
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();    ///< Position of the scanner.
  std::int64_t lines = 0;                           ///< Number of lines of the header.
  std::int64_t unknown_lines = 0;                   ///< Number of lines without a keyword of PCD.

  const PcdField& axis(int i) const { return fields[axes[i]]; }
};

/// Reads the header and leaves the source behind its last line's end. Throws Error if it does not
/// describe a grid of points with x, y and z.
PcdHeader read_pcd_header(ByteSource& source);

}  // namespace semigeo::io
