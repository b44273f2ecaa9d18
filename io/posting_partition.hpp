#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace semigeo::io {

/// The key of the job that made a partition; Error if the file is not a whole partition of this
/// version. Reads a few kB.
std::string posting_partition_key(const std::filesystem::path& path);

}  // namespace semigeo::io
