#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/files/chunk_codec.hpp"
#include "jobs/stages/evolving_surface.hpp"
#include "jobs/stages/level_features.hpp"
#include "jobs/stages/prepare_surface.hpp"
#include "jobs/stages/recognise_scene.hpp"
#include "jobs/stages/recognition_features.hpp"

namespace semigeo::jobs {

/// Everything besides the scan itself that a dataset's content depends on.
struct SurfaceParameters {
  int levels = 8;  ///< smoothing iterations; the dataset has levels + 1 levels
  PreparationOptions preparation = {};
  EvolutionOptions evolution = {};
  FeatureOptions features = {};
  std::optional<int> recognition_level = {};  ///< else the one of least slope (thesis 5.8)
  io::Compression compression = io::Compression::deflate;
  std::string length_unit = "unknown";
};

/// The parameters as JSON with sorted keys: the same parameters, the same text.
std::string to_json(const SurfaceParameters& parameters);
/// The parameters again. Throws std::runtime_error on a text that to_json does not give.
SurfaceParameters parameters_from_json(const std::string& text);

/// The same of recognition: what a run of triplets depends on besides its dataset.
std::string to_json(const RecognitionParameters& parameters);
RecognitionParameters recognition_parameters_from_json(const std::string& text);

enum class RecognitionMethod {
  kOverlap,  ///< stages/recognise_scene.hpp
  kThesis    ///< stages/thesis_recognition.hpp
};

/// What a recognition depends on besides the scene and the library.
struct SearchParameters {
  RecognitionMethod method = RecognitionMethod::kOverlap;
  double min_score = RecognitionOptions{}.min_score;  ///< below it a model is not in the scene
};

std::string to_json(const SearchParameters& parameters);
SearchParameters search_parameters_from_json(const std::string& text);

/// What jobs depend on besides their inputs: each kind on its part.
struct JobParameters {
  SurfaceParameters surface = {};
  RecognitionParameters recognition = {};
  SearchParameters search = {};
};

/// What `semigeo run` was asked to do.
struct RunConfig {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path archive;
  JobParameters jobs;
  int threads = 0;  ///< 0: all cores
};

}  // namespace semigeo::jobs
