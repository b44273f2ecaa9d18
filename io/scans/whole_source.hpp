#pragma once

#include <cstdint>
#include <string>

#include "io/files/byte_source.hpp"

namespace semigeo::io {

/// The largest number of bytes of a file that is read into memory as a whole.
inline constexpr std::int64_t kMaxWholeBytes = std::int64_t{1} << 32;

/// Reads up to `most` bytes, or to the end of the source if that comes first. Memory grows with
/// what is read. Throws Error if more than kMaxWholeBytes are asked for and there.
std::string read_whole(ByteSource& source, std::int64_t most = kMaxWholeBytes + 1);

}  // namespace semigeo::io
