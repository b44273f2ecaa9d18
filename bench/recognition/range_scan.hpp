#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "bench/recognition/bench_model.hpp"
#include "bench/recognition/scenes.hpp"

namespace semigeo::recognition {

/// Holds a real scene that was scanned from one side, and a model whose pose in it is known.
struct RangeScan {
  std::unique_ptr<BenchModel> model;
  Scene scene;  ///< Its kind is G. The index of its object is not set.
};

/// Reads the dinosaur of the UWA data set and the scene rs1 from `folder`. Returns nothing if they
/// are not there. Model and scene are decimated to these numbers of vertices (0: no decimation).
/// Throws io::Error if a file cannot be read.
std::optional<RangeScan> read_range_scan(const std::filesystem::path& folder,
                                         std::int64_t model_vertices, std::int64_t scene_vertices);

}  // namespace semigeo::recognition
