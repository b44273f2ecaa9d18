#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/recognition/bench_model.hpp"
#include "bench/recognition/trial.hpp"
#include "engine/run_context.hpp"
#include "jobs/stages/recognise_scene.hpp"
#include "jobs/stages/recognition_features.hpp"

namespace semigeo::recognition {

/// Kinds that scene_kinds() does not have.
inline constexpr char kRangeScan[] = "G";       ///< range_scan.hpp
inline constexpr char kFalsePositives[] = "X";  ///< A to E with a library without the object

struct ExperimentOptions {
  std::vector<std::string> kinds;
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 1;  ///< scenes of each kind and object
  std::int64_t model_vertices = 5000;
  std::int64_t scan_vertices = 20000;  ///< of G's scene
  std::filesystem::path scan_folder;   ///< with G's files
  jobs::RecognitionParameters parameters;
  jobs::RecognitionOptions recognition;
};

/// A method with a library that it keeps a reference to.
using Method = std::function<Recogniser(const io::HashLibrary& library)>;

/// All scenes, kind after kind; each is told as soon as it is done. Libraries are written into
/// `folder`. G is passed over if its files are not there. Throws io::Error, std::runtime_error.
std::vector<Outcome> run_experiments(BenchModels& models, const Method& method,
                                     const ExperimentOptions& options,
                                     const std::filesystem::path& folder,
                                     const std::function<void(const Outcome&)>& told,
                                     const engine::RunContext& context);

std::vector<std::string> model_names(const io::HashLibrary& library);

}  // namespace semigeo::recognition
