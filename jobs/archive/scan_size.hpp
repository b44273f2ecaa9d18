#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace semigeo::jobs {

/// The format and the size of a scan, known without reading it.
struct ScanSize {
  std::string format;        ///< "PLY binary", "PLY ascii", "OBJ", "STL binary, gzip", ...
  std::uintmax_t bytes = 0;  ///< Size of the file, with its companions (io/scans/companions.hpp).
};

/// Returns the format and the size. They need only the first kilobyte of the file, and for a file
/// with companions its JSON. They are empty and 0 if the file cannot be read. A member of a
/// container is not looked for, because that may need a pass over the container: its format is the
/// likely one, and its size 0.
ScanSize scan_size(const std::filesystem::path& scan);

}  // namespace semigeo::jobs
