#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/run_context.hpp"
#include "io/library/hash_library.hpp"
#include "jobs/stages/recognition_tuning.hpp"
#include "kernels/recognition/overlap.hpp"
#include "kernels/recognition/recognition_model.hpp"
#include "kernels/recognition/similarity.hpp"

namespace semigeo::jobs {

/// The sizes that objects may have, in sizes of their models.
struct ScaleRange {
  double least = 0;
  double most = std::numeric_limits<double>::infinity();

  bool has(double scale) const { return scale >= least && scale <= most; }
  bool is_any() const { return least <= 0 && most == std::numeric_limits<double>::infinity(); }
  /// Returns the range for scales that single matches suggest, which are less exact.
  ScaleRange widened() const { return {least / 1.15, most * 1.15}; }
};

/// How models are found in a scene.
struct RecognitionOptions {
  double min_score = 0.15;  ///< A model with less is not in the scene: see bench/RECOGNITION.md.
  ScaleRange scale = {};    ///< Poses of other scales are left out.
  RecognitionTuning tuning = {};
};

/// A model and the pose in which it may be in the scene.
struct Candidate {
  std::int64_t model = 0;  ///< Index in HashLibrary::models.
  double votes = 0;      ///< Votes of the scene's triplets; each vote is shared among its matches.
  double cluster = 0;    ///< Weight of the matches that agree on the pose as it was found.
  double support = 0;    ///< Weight of the matches that agree on the refined pose.
  double match = 0;      ///< Share of the model's surface that lies on the scene's.
  double conflict = 0;   ///< Share of the model near the scene's surface that contradicts it.
  double closeness = 0;  ///< How close what matches lies: 1 on the surface, 0 at the tolerance.
  double stability = 0;  ///< How firmly what matches holds the model: kernels::Overlap.
  double explained = 0;  ///< Share of the scene's surface that lies on the model's.
  double score = 0;      ///< What counts: see ScoreWeights and ViewTuning.
  /// How the model lies in what the scanner saw, if the scene was seen from one place.
  std::optional<kernels::View> view = {};
  double view_score = 0;     ///< The score that counts in such a scene, before its weight.
  kernels::Similarity pose;  ///< Leads from the model to the scene, in coordinates of the files.
};

/// What was found in a scene.
struct Recognition {
  std::vector<Candidate> ranking;   ///< The best pose of each verified model, best first.
  std::vector<Candidate> objects;   ///< What is in the scene, in the order in which it was found.
  std::int64_t scene_triplets = 0;  ///< Number of triplets of the scene.
  std::int64_t matches = 0;         ///< Number of matches of triplets.
  /// How much each model resembles the scene as a whole, if that is asked for: `resemblances`.
  std::vector<double> resemblance = {};
};

/// Finds models of a library in a scene. The result does not depend on the number of threads.
/// Throws io::Error if the library cannot be read. Source: thesis 4.5, 4.6. Differs: poses are
/// judged by how surfaces overlap, not by triplets alone.
Recognition recognise_scene(const io::HashLibrary& library, const kernels::RecognitionModel& scene,
                            const RecognitionOptions& options, const engine::RunContext& context);

}  // namespace semigeo::jobs
