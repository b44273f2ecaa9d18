#pragma once

#include <optional>
#include <string>

#include "io/files/chunk_codec.hpp"
#include "jobs/stages/evolving_surface.hpp"
#include "jobs/stages/level_features.hpp"
#include "jobs/stages/prepare_surface.hpp"

namespace semigeo::jobs {

/// Everything besides the scan itself that the content of a dataset depends on.
struct SurfaceParameters {
  int levels = 8;  ///< Number of smoothing iterations; the dataset has one more level.
  PreparationOptions preparation = {};
  EvolutionOptions evolution = {};
  FeatureOptions features = {};
  /// The level for recognition. If there is none, it is the level of least slope (thesis 5.8).
  std::optional<int> recognition_level = {};
  io::Compression compression = io::Compression::deflate;
  std::string length_unit = "unknown";  ///< Label of the scan's length unit, as UTF-8.
};

/// Returns the parameters as JSON with sorted keys: the same parameters give the same text.
std::string to_json(const SurfaceParameters& parameters);

/// Reads what `to_json` returns. Throws std::runtime_error on every other text.
SurfaceParameters surface_parameters_from_json(const std::string& text);

}  // namespace semigeo::jobs
