#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace semigeo::kernels {

/// Sorts keys by their bits [first, last), ascending. Keys that are equal there keep their order.
/// The cost is two passes over the keys for each 11 bits, and as much memory again as the keys.
inline void radix_sort(std::vector<std::uint64_t>& keys, int first, int last) {
  constexpr int kDigit = 11;
  constexpr std::uint64_t kMask = (1U << kDigit) - 1;
  std::vector<std::uint64_t> sorted(keys.size());
  for (int shift = first; shift < last; shift += kDigit) {
    const std::uint64_t mask = last - shift < kDigit ? (1U << (last - shift)) - 1 : kMask;
    std::array<std::size_t, kMask + 1> next = {};
    for (const std::uint64_t key : keys) ++next[key >> shift & mask];
    std::size_t begin = 0;
    for (std::size_t& place : next) begin += std::exchange(place, begin);
    for (const std::uint64_t key : keys) sorted[next[key >> shift & mask]++] = key;
    keys.swap(sorted);
  }
}

}  // namespace semigeo::kernels
