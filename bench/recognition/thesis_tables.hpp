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

/// Holds one experiment of thesis 6.4.
struct ThesisExperiment {
  std::string title;
  std::vector<std::string> scenes;                     ///< Names of the scenes.
  std::vector<std::vector<std::string>> truth;         ///< (scenes) Models that are in each scene.
  std::vector<std::vector<jobs::ThesisScore>> scores;  ///< (scenes, models) Scores of the models.
  std::vector<std::string> recognised;  ///< (scenes) First model in the ranking of recognise_scene.
};

/// Holds all experiments of thesis 6.4.
struct ThesisTables {
  std::vector<std::string> models;          ///< Names of the models, in the order of the library.
  std::vector<std::string> placed;          ///< (models) Names of the models, scene after scene.
  std::vector<ThesisPlacement> placements;  ///< Placements in complete and partial scenes.
  ThesisExperiment complete;                ///< Tables 6.2 and 6.3 of the thesis.
  ThesisExperiment partial;                 ///< Tables 6.4 and 6.5 of the thesis.
  ThesisExperiment composed;                ///< Table 6.6 of the thesis.
};

/// Repeats the experiments of thesis 6.4 with these models. Scenes are made of other meshes of the
/// same surfaces, because the thesis says that models and scenes differ in smoothing and
/// decimation. Complete and partial scenes get the scales and angles of table 6.1, model after
/// model. Partial scenes lose 60 % of their vertices, in a ball. Three scenes have three objects
/// each. Libraries are written into `folder`. Throws io::Error if they cannot be written.
ThesisTables thesis_tables(ModelSpan models, const jobs::RecognitionParameters& parameters,
                           const jobs::ThesisRecognitionOptions& options, std::uint64_t seed,
                           const std::filesystem::path& folder, const engine::RunContext& context);

/// Prints the tables on stdout, with a row for each model and a column for each scene.
void print(const ThesisTables& tables);
/// Returns the tables as JSON.
std::string json(const ThesisTables& tables);

}  // namespace semigeo::recognition
