#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace semigeo::io {

/// XXH3-128 of the file's raw bytes (of the compressed ones for a .gz), as the 32 hexadecimal
/// digits that `xxhsum -H2` prints. Reads the file once through a small buffer; an `Error` when it
/// cannot be read.
std::string xxh3_of_file(const std::filesystem::path& path);

/// XXH3-128 of a text, as 32 hexadecimal digits.
std::string xxh3_of_text(std::string_view text);

}  // namespace semigeo::io
