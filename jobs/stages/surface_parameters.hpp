#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "io/files/chunk_codec.hpp"
#include "jobs/stages/evolving_surface.hpp"
#include "jobs/stages/level_features.hpp"
#include "jobs/stages/parameter.hpp"
#include "jobs/stages/prepare_surface.hpp"
#include "jobs/stages/stored_precision.hpp"
#include "kernels/repair/range_grid.hpp"
#include "kernels/repair/surface_builder.hpp"

namespace semigeo::jobs {

/// Holds all parameters of a dataset: everything that its content depends on besides the scan.
struct SurfaceParameters {
  int levels = 8;  ///< Number of smoothing iterations; the dataset has one more level.
  double depth_jump = kernels::kDepthJump;  ///< See `kernels::triangulate_grid`.
  std::string weld = "auto";                ///< Which gaps are closed: "auto", "exact" or a length.
  PreparationOptions preparation = {};
  EvolutionOptions evolution = {};
  FeatureOptions features = {};
  /// The level for recognition. If there is none, it is the level of least slope (thesis 5.8).
  std::optional<int> recognition_level = {};
  io::Compression compression = io::Compression::kDeflate;
  Precision precision = Precision::kFull;
  std::string length_unit = "unknown";  ///< Label of the scan's length unit, as UTF-8.
};

/// Returns what each of the parameters is called and which values it may have, in the order of the
/// help text. A parameter is declared there and nowhere else.
const ParameterTable<SurfaceParameters>& surface_parameter_table();

/// Returns what `weld` says. A text that is none of its values is "auto".
kernels::Welding welding_of(const SurfaceParameters& parameters);

/// Returns the parameters as JSON with sorted keys.
nlohmann::json json_of(const SurfaceParameters& parameters);

/// Returns that JSON as text: the same parameters give the same text.
std::string to_json(const SurfaceParameters& parameters);

/// Reads what `json_of` returns. Throws std::runtime_error on every other value.
SurfaceParameters surface_parameters_from_json(const nlohmann::json& json);

}  // namespace semigeo::jobs
