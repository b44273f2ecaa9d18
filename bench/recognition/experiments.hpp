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

// These kinds of experiments are not among scene_kinds().
inline constexpr char kRangeScan[] = "G";       ///< The real scene of range_scan.hpp.
inline constexpr char kFalsePositives[] = "X";  ///< Scenes A to E, whose object no library has.
inline constexpr char kAbsentHeaps[] = "XR";    ///< Scenes of kind R, whose objects no library has.

/// Says which experiments are made, and how.
struct ExperimentOptions {
  std::vector<std::string> kinds;      ///< Names of the kinds of scenes.
  std::uint64_t first_seed = 1;        ///< Seed of the first scene of each kind and object.
  std::uint64_t seeds = 1;             ///< Number of scenes of each kind and object.
  int heaps = 20;                      ///< Number of scenes of kinds R and XR of each seed.
  bool diagnose = true;                ///< Whether it is examined where objects of heaps are lost.
  std::int64_t model_vertices = 5000;  ///< Number of vertices of the model of kind G.
  std::int64_t scan_vertices = 20000;  ///< Number of vertices of the scene of kind G.
  std::filesystem::path scan_folder;   ///< Folder with the files of kind G.
  jobs::RecognitionParameters parameters;
  jobs::RecognitionOptions recognition;
};

/// Returns a recogniser for a library. The recogniser keeps a reference to the library.
using Method = std::function<Recogniser(const io::HashLibrary& library)>;

/// Recognises all scenes, kind after kind, and returns what became of them. `told` is called after
/// each scene. Libraries are written into `folder`. Kind G is left out if its files are missing.
/// Throws io::Error if a file cannot be read or written, and std::runtime_error if OpenMesh cannot
/// hold a model.
std::vector<Outcome> run_experiments(BenchModels& models, const Method& method,
                                     const ExperimentOptions& options,
                                     const std::filesystem::path& folder,
                                     const std::function<void(const Outcome&)>& told,
                                     const engine::RunContext& context);

/// Returns the names of the models of a library, in its order.
std::vector<std::string> model_names(const io::HashLibrary& library);

}  // namespace semigeo::recognition
