#pragma once

#include <filesystem>
#include <string>

#include "kernels/repair/surface_builder.hpp"

namespace semigeo::jobs {

/// What a scan file holds, repaired.
struct ScanSurface {
  kernels::BuiltSurface built;
  std::string format;        ///< of the scan: "PLY binary little endian", ...
  std::string repairs_json;  ///< counts of what was changed and passed over, keys sorted
};

/// Counts as JSON with sorted keys.
std::string to_json(const kernels::SurfaceRepairs& repairs);

/// Reads and repairs a scan. `xxh3` is the digest of its bytes as they were. Throws io::Error on an
/// unreadable scan, one that changed meanwhile, one without a usable triangle, and one whose
/// lengths no single precision holds.
ScanSurface read_surface(const std::filesystem::path& scan, const std::string& xxh3);

}  // namespace semigeo::jobs
