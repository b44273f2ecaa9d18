#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bench/recognition/judgement.hpp"
#include "bench/recognition/scenes.hpp"
#include "engine/run_context.hpp"
#include "jobs/stages/recognise_scene.hpp"
#include "jobs/stages/recognition_features.hpp"

namespace semigeo::recognition {

/// What recognises: the scene in, what was found out, with models by name.
using Recogniser = std::function<jobs::Recognition(const kernels::RecognitionModel& scene)>;

struct Seconds {
  double wall = 0;
  double cpu = 0;  ///< of all threads
};

/// What became of an object of a scene.
struct ObjectOutcome {
  std::string model;
  int rank = 0;           ///< in the ranking, from 1; 0: not there
  double score = 0;       ///< there
  PoseError ranked;       ///< of the pose there
  bool reported = false;  ///< among the objects, with the right pose
};

/// What became of a scene.
struct Outcome {
  std::string kind;
  std::string scene;
  std::uint64_t seed = 0;
  std::int64_t vertices = 0;
  std::int64_t features = 0;
  std::vector<ObjectOutcome> objects;
  std::string first;       ///< that the ranking begins with; empty: it is empty
  std::string best_wrong;  ///< of the ranking
  double best_wrong_score = 0;
  int false_objects = 0;   ///< reported, but not there, or not so
  std::string false_best;  ///< the best of them
  double false_score = 0;
  std::int64_t scene_triplets = 0;
  std::int64_t matches = 0;
  Seconds scale_space;  ///< features and samples of the scene
  Seconds search;       ///< the rest

  /// The ranking begins with the objects of the scene.
  bool named() const;
  /// And their poses are right; of several copies one is enough.
  bool posed() const;
  /// All are among the objects, with the right poses.
  bool reported() const;
};

/// Looks at a scene. `names` are those of the library's models.
Outcome try_scene(const Scene& scene, ModelSpan models, const std::vector<std::string>& names,
                  const Recogniser& recogniser, const jobs::RecognitionParameters& parameters,
                  const engine::RunContext& context);

/// Compares what was found with what is there; no clocks, no vertices.
Outcome judged(const Scene& scene, ModelSpan models, const std::vector<std::string>& names,
               const jobs::Recognition& found);

}  // namespace semigeo::recognition
