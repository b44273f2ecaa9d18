#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace semigeo::io {

/// Returns the number whose bytes, in the given order, stand at `from` (which need not be aligned).
template <typename Number>
Number load(const char* from, std::endian order) {
  std::array<char, sizeof(Number)> bytes;
  std::memcpy(bytes.data(), from, bytes.size());
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<Number>(bytes);
}

}  // namespace semigeo::io
