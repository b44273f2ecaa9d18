#pragma once

#include <cstdint>
#include <filesystem>

#include "io/files/error.hpp"

namespace semigeo::io {

/// The bounds of what compressed data may grow to. Data beyond them was made to fill a memory or a
/// disk, or is damaged.
inline constexpr std::int64_t kMostUnpacked = std::int64_t{64} << 30;
inline constexpr std::int64_t kUnsuspicious = std::int64_t{1} << 30;  ///< Any ratio is fine below.
inline constexpr std::int64_t kMostRatio = 1100;  ///< Deflate reaches 1032 with zeros.

/// Throws Error if `unpacked` bytes out of `packed` ones are beyond the bounds.
inline void check_growth(const std::filesystem::path& path, std::int64_t packed,
                         std::int64_t unpacked) {
  if (unpacked <= kUnsuspicious) return;
  if (unpacked <= kMostUnpacked && unpacked / kMostRatio <= packed) return;
  throw Error(path, "",
              unpacked > kMostUnpacked
                  ? "its compressed data grows beyond 64 GiB"
                  : "its compressed data grows to more than 1100 times its size",
              "unpack it and give the scan itself if this is meant to be so");
}

}  // namespace semigeo::io
