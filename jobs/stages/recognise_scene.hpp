#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/run_context.hpp"
#include "io/library/hash_library.hpp"
#include "kernels/recognition/recognition_model.hpp"
#include "kernels/recognition/similarity.hpp"

namespace semigeo::jobs {

struct RecognitionOptions {
  double min_score = 0.15;  ///< below it a model is not in the scene; see bench/RECOGNITION.md
};

/// A model and where it seems to be.
struct Candidate {
  std::int64_t model = 0;  ///< of HashLibrary::models
  double votes = 0;        ///< of scene triplets, each shared among what it matches
  double cluster = 0;      ///< weight of the matches that agree on this pose, as it was found
  double support = 0;      ///< and as it is now
  double match = 0;        ///< share of the model's surface that lies on the scene's
  double conflict = 0;     ///< share near the scene's surface that disagrees with it
  double closeness = 0;    ///< of what matches: 1 on the scene's surface, 0 at the tolerance
  double stability = 0;    ///< how firmly what matches holds the model: kernels::Overlap
  double explained = 0;    ///< share of the scene's surface that lies on the model's
  double score = 0;
  kernels::Similarity pose;  ///< model to scene, in coordinates of the files
};

struct Recognition {
  std::vector<Candidate> ranking;  ///< the best pose of each model that was verified, best first
  std::vector<Candidate> objects;  ///< what is in the scene, in the order in which it was found
  std::int64_t scene_triplets = 0;
  std::int64_t matches = 0;
};

/// Finds models of a library in a scene. The result does not depend on the number of threads.
Recognition recognise_scene(const io::HashLibrary& library, const kernels::RecognitionModel& scene,
                            const RecognitionOptions& options, const engine::RunContext& context);

}  // namespace semigeo::jobs
