#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/files/byte_stream.hpp"

namespace semigeo::io {

/// Returns the XXH3-128 of the file's raw bytes (for a .gz, of the compressed ones), as the 32
/// hexadecimal digits that `xxhsum -H2` prints. Reads the file once through a small buffer. Throws
/// Error if it cannot be read.
///
/// The path may lead to a member of a container (container.hpp). Its bytes are then those of the
/// file that would be unpacked.
std::string xxh3_of_file(const std::filesystem::path& path);

/// Returns the same of the bytes that a stream still has.
std::string xxh3_of_stream(ByteStream& stream);

/// Returns the XXH3-128 of a text, as 32 hexadecimal digits.
std::string xxh3_of_text(std::string_view text);

}  // namespace semigeo::io
