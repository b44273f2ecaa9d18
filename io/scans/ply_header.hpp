#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/files/byte_source.hpp"

namespace semigeo::io {

/// The types of numbers in a PLY.
enum class PlyType {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64
};

/// Returns the size of a number in bytes.
int ply_type_size(PlyType type);
/// Returns whether the type is one of integers.
inline bool is_integer(PlyType type) {
  return type < PlyType::kFloat32;
}

/// A property of the records of an element: a number, or a list of numbers.
struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat32;     ///< Type of the value, or of a list's items.
  std::optional<PlyType> count_type{};  ///< Type of a list's length; empty if it is not a list.
};

/// One table of the file: `count` records of the same properties.
struct PlyElement {
  std::string name;
  std::int64_t count = 0;
  std::int64_t line = 0;  ///< Line of the header that declares it.
  std::vector<PlyProperty> properties;

  /// Returns the number of bytes that a record has at least: exactly its size in binary files if it
  /// holds no list.
  std::int64_t least_bytes(bool ascii) const;
};

/// Holds the header of a PLY.
struct PlyHeader {
  /// The encoding of the data behind the header.
  enum class Encoding { kAscii, kLittleEndian, kBigEndian };
  Encoding encoding = Encoding::kAscii;
  std::vector<PlyElement> elements;
  std::int64_t lines = 0;          ///< Number of lines of the header.
  std::int64_t unknown_lines = 0;  ///< Number of lines that begin with no keyword of PLY.
  /// Size of the element `range_grid`, from `obj_info num_rows` and `obj_info num_cols`.
  std::optional<std::int64_t> grid_rows, grid_columns;
};

/// Reads the header and leaves the source behind its last line's end. Lines that begin with no
/// keyword of PLY are passed over and counted.
PlyHeader read_ply_header(ByteSource& source);

}  // namespace semigeo::io
