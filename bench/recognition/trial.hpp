#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/recognition/diagnosis.hpp"
#include "bench/recognition/judgement.hpp"
#include "bench/recognition/scenes.hpp"
#include "engine/run_context.hpp"
#include "jobs/stages/recognise_scene.hpp"
#include "jobs/stages/recognition_features.hpp"

namespace semigeo::recognition {

/// Recognises models in a scene, and returns what was found.
using Recogniser = std::function<jobs::Recognition(const kernels::RecognitionModel& scene)>;

/// Holds a time in seconds.
struct Seconds {
  double wall = 0;  ///< Time on the clock.
  double cpu = 0;   ///< CPU time of all threads together.
};

/// Tells whether an object of a scene was recognised.
struct ObjectOutcome {
  std::string model;      ///< Name of the object's model.
  int rank = 0;           ///< Place of the model in the ranking, from 1; 0: it is not there.
  double score = 0;       ///< Score of the model in the ranking.
  PoseError ranked;       ///< Error of the pose in the ranking.
  bool reported = false;  ///< The model is among the objects found, with the right pose.
  double occlusion = 0;   ///< See PlacedObject.
  double clutter = 0;     ///< See PlacedObject.
  std::optional<Diagnosis> diagnosis = {};  ///< Of an object in a heap that is not reported.
};

/// Describes a model of the ranking.
struct RankedModel {
  std::string model;   ///< Its name.
  bool right = false;  ///< It is in the scene, in this pose.
  jobs::Candidate candidate;
};

/// Tells what was recognised in a scene.
struct Outcome {
  std::string kind;
  std::string scene;
  std::uint64_t seed = 0;
  std::int64_t vertices = 0;
  std::int64_t features = 0;
  double noise = 0;           ///< Noise of the scanner, in pixels.
  bool mixed_pixels = false;  ///< See Scene.
  std::vector<ObjectOutcome> objects;
  std::string first;            ///< First model of the ranking; empty if the ranking is.
  std::string best_wrong;       ///< Best model of the ranking that is not in the scene.
  double best_wrong_score = 0;  ///< Score of that model.
  int false_objects = 0;   ///< Number of objects found that are not there, or not in that pose.
  std::string false_best;  ///< Model of the false object with the best score.
  double false_score = 0;  ///< Score of that object.
  std::int64_t scene_triplets = 0;
  std::int64_t matches = 0;
  bool single_view = false;          ///< The scene is taken to be seen from one place.
  std::vector<RankedModel> ranking;  ///< Best first.
  Seconds scale_space;               ///< Time for the features and samples of the scene.
  Seconds search;                    ///< Time for everything after that.

  /// Returns whether the ranking begins with the objects of the scene.
  bool named() const;
  /// Returns whether, besides, their poses are right. One copy of an object is enough.
  bool posed() const;
  /// Returns whether all objects of the scene are among the objects found, with the right poses.
  bool reported() const;
};

/// Is called with a recognised scene and what became of it, which it may add to.
using Inspector = std::function<void(const kernels::RecognitionModel& scene, Outcome& outcome)>;

/// Recognises a scene and judges the result. `names` are the names of the library's models.
/// `inspect` may be empty.
Outcome try_scene(const Scene& scene, ModelSpan models, const std::vector<std::string>& names,
                  const Recogniser& recogniser, const Inspector& inspect,
                  const jobs::RecognitionParameters& parameters, const engine::RunContext& context);

/// Judges what was found in a scene. Times and the number of vertices are not set.
Outcome judged(const Scene& scene, ModelSpan models, const std::vector<std::string>& names,
               const jobs::Recognition& found);

}  // namespace semigeo::recognition
