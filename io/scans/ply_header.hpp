#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/files/byte_source.hpp"

namespace semigeo::io {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

int ply_type_size(PlyType type);
inline bool is_integer(PlyType type) {
  return type < PlyType::float32;
}

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;      ///< of the value, or of a list's items
  std::optional<PlyType> count_type{};  ///< of a list's length; none: not a list
};

/// One table of the file: `count` records of the same properties.
struct PlyElement {
  std::string name;
  std::int64_t count = 0;
  std::int64_t line = 0;  ///< where the header declares it
  std::vector<PlyProperty> properties;

  /// Bytes that a record has at least: exactly its size in binary files if it holds no list.
  std::int64_t least_bytes(bool ascii) const;
  bool has_lists() const;
};

struct PlyHeader {
  enum class Encoding { ascii, little_endian, big_endian };
  Encoding encoding = Encoding::ascii;
  std::vector<PlyElement> elements;
  std::int64_t lines = 0;  ///< of the header
};

/// Reads the header and leaves the source behind its last line's end.
PlyHeader read_ply_header(ByteSource& source);

}  // namespace semigeo::io
