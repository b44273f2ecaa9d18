#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/recognition/bench_model.hpp"
#include "bench/recognition/scenes.hpp"
#include "engine/run_context.hpp"
#include "jobs/stages/recognition_features.hpp"
#include "jobs/stages/thesis_recognition.hpp"

namespace semigeo::recognition {

/// One experiment of thesis 6.4: models down, scenes across.
struct ThesisExperiment {
  std::string title;
  std::vector<std::string> scenes;
  std::vector<std::vector<std::string>> truth;         ///< (scenes) the models that are there
  std::vector<std::vector<jobs::ThesisScore>> scores;  ///< (scenes, models)
  std::vector<std::string> recognised;                 ///< (scenes) first of recognise_scene
};

struct ThesisTables {
  std::vector<std::string> models;
  std::vector<std::string> placed;          ///< (models) the same models, scene after scene
  std::vector<ThesisPlacement> placements;  ///< of their complete and partial scenes: 6.1
  ThesisExperiment complete;                ///< 6.2, 6.3
  ThesisExperiment partial;                 ///< 6.4, 6.5
  ThesisExperiment composed;                ///< 6.6
};

/// The experiments of 6.4 with these models. Scenes are re-digitised: the thesis says that models
/// and scenes differ in smoothing and decimation. Complete and partial ones get the scale factors
/// and angles of 6.1, model after model; partial ones lose 60 % of their vertices, a ball; three
/// scenes are composed of three objects. Libraries are written into `folder`.
ThesisTables thesis_tables(ModelSpan models, const jobs::RecognitionParameters& parameters,
                           const jobs::ThesisRecognitionOptions& options, std::uint64_t seed,
                           const std::filesystem::path& folder, const engine::RunContext& context);

void print(const ThesisTables& tables);
std::string json(const ThesisTables& tables);

}  // namespace semigeo::recognition
