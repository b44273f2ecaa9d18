#pragma once

#include <cstdint>
#include <string>

#include "io/files/byte_source.hpp"

namespace semigeo::io {

/// The place in a file where a record begins. It is cheap to pass along, and is put into words only
/// when a message needs it.
struct Place {
  /// The unit in which places are counted. Vertices and faces are counted from zero.
  enum class Unit { kLine, kByte, kVertex, kFace };
  Unit unit = Unit::kLine;
  std::int64_t number = 0;

  /// Returns the place in words: "line 12".
  std::string text(const ByteSource& source) const {
    if (unit == Unit::kByte) return source.place(number);
    constexpr const char* kNames[] = {"line ", "byte ", "vertex ", "face "};
    return kNames[static_cast<int>(unit)] + std::to_string(number);
  }
};

}  // namespace semigeo::io
