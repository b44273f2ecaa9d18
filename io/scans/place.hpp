#pragma once

#include <cstdint>
#include <string>

#include "io/files/byte_source.hpp"

namespace semigeo::io {

/// The place in a file where a record begins: cheap to pass along, put into words only when it is
/// needed.
struct Place {
  enum class Unit { kLine, kByte };
  Unit unit = Unit::kLine;
  std::int64_t number = 0;

  std::string text(const ByteSource& source) const {
    return unit == Unit::kLine ? "line " + std::to_string(number) : source.place(number);
  }
};

}  // namespace semigeo::io
