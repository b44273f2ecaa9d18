#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace semigeo::jobs {

/// What can be told of a scan without reading it.
struct ScanSize {
  std::string format;        ///< "PLY binary", "PLY ascii", "OBJ", "STL binary, gzip", ...
  std::uintmax_t bytes = 0;  ///< of the file
};

/// From the file's size and its first kilobyte. Nothing of what cannot be read.
ScanSize scan_size(const std::filesystem::path& scan);

}  // namespace semigeo::jobs
