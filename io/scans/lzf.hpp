#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace semigeo::io {

/// Returns the `size` bytes that LZF has packed, or nothing if the packed bytes are damaged or hold
/// another number of bytes. Memory follows what the packed bytes hold, never `size`.
///
/// Source: the format of liblzf. A byte below 32 is followed by one more literal byte than it says.
/// Any other byte refers back: the upper 3 bits are the length less 2 (7: a byte follows that is
/// added), the lower 5 bits and the next byte are the distance less 1.
std::optional<std::string> unpack_lzf(std::string_view packed, std::size_t size);

}  // namespace semigeo::io
