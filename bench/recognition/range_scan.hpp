#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "bench/recognition/bench_model.hpp"
#include "bench/recognition/scenes.hpp"

namespace semigeo::recognition {

/// A real scene, seen from one side, with a model in it whose pose others have measured.
struct RangeScan {
  std::unique_ptr<BenchModel> model;
  Scene scene;  ///< of kind G; its object's index is not set
};

/// The dinosaur of the UWA data set in scene rs1, from `folder`; nothing if it is not there. Model
/// and scene are decimated to so many vertices (0: as they are). Throws io::Error.
std::optional<RangeScan> read_range_scan(const std::filesystem::path& folder,
                                         std::int64_t model_vertices, std::int64_t scene_vertices);

}  // namespace semigeo::recognition
