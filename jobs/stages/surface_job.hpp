#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "engine/run_context.hpp"
#include "jobs/stages/prepare_surface.hpp"
#include "jobs/stages/scan_surface.hpp"
#include "jobs/stages/surface_parameters.hpp"
#include "kernels/repair/remeshing.hpp"

namespace semigeo::jobs {

/// A job that reads a scan and writes its dataset.
struct SurfaceJob {
  std::filesystem::path input;
  std::string input_name;  ///< Name of the scan in the dataset, as UTF-8.
  std::string name;        ///< Name of the dataset.
  std::filesystem::path output;
  std::string input_xxh3;  ///< Digest of the scan's bytes.
  std::string key;         ///< Hash of everything the dataset depends on.
};

/// Says why curvatures of level 0 may be missing or noise. All lengths are in the scan's unit.
struct ScanQuality {
  double mean_edge_length = 0;      ///< Without outliers; see `kernels::edge_lengths`.
  double coordinate_step = 0;       ///< Step of the coordinates' precision.
  double weld_distance = 0;         ///< Width of the widest gap that may have been closed.
  std::int64_t without_patch = 0;   ///< Vertices of level 0 without a valid patch.
  std::int64_t on_small_parts = 0;  ///< Those of them on parts that are smaller than a patch.

  bool operator==(const ScanQuality&) const = default;
};

/// Describes the output of a surface job.
struct SurfaceJobResult {
  std::string format;  ///< File format of the scan.
  std::int64_t vertices = 0;
  std::int64_t triangles = 0;
  std::int32_t parts = 0;
  std::int64_t levels = 0;
  ScanRepairs repairs;
  ScanQuality quality;
  PreparationResult preparation;
  kernels::RemeshCounts remeshed;  ///< Sum over all levels.
  bool vanished = false;           ///< The last level is only a triangle or a tetrahedron.
};

/// Returns the counts that datasets have as JSON with sorted keys.
nlohmann::json json_of(const kernels::RemeshCounts& remeshed);

/// Reads and repairs one scan, evolves it through all levels and writes its dataset, which gets
/// its final name only when it is complete and verified. Throws io::Error if the scan
/// cannot be read or used, if it has changed meanwhile, or if the dataset cannot be written.
SurfaceJobResult run_surface_job(const SurfaceJob& job, const SurfaceParameters& parameters,
                                 const engine::RunContext& context);

}  // namespace semigeo::jobs
