#pragma once

#include <cstdint>

namespace semigeo::kernels {

/// Returns the low 21 bits of x with two zero bits after each of them. Three coordinates that are
/// spread so, shifted by 0, 1 and 2 bits, and joined make a Z-order (Morton) code.
constexpr std::uint64_t spread_bits(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffffu;
  x = (x | x << 16) & 0x1f0000ff0000ffu;
  x = (x | x << 8) & 0x100f00f00f00f00fu;
  x = (x | x << 4) & 0x10c30c30c30c30c3u;
  x = (x | x << 2) & 0x1249249249249249u;
  return x;
}

}  // namespace semigeo::kernels
