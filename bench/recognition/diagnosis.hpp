#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/run_context.hpp"
#include "io/library/hash_library.hpp"
#include "jobs/stages/match_triplets.hpp"
#include "jobs/stages/pose_examiner.hpp"
#include "jobs/stages/recognise_scene.hpp"
#include "kernels/recognition/similarity.hpp"

namespace semigeo::recognition {

/// Tells how far the true pose of an object gets in recognition.
struct Diagnosis {
  std::int64_t features = 0;  ///< Features of the model that the scene has at the same place.
  std::int64_t matches = 0;   ///< Matches of triplets that speak for the true pose.
  double votes = 0;           ///< Their weight, of those that vote.
  double cluster = 0;         ///< Weight of the heaviest cluster that has the true pose, or 0.
  double score = 0;           ///< Score of the true pose after its refinement.

  /// Returns where an object was lost that is not reported: at its "features", "triplets", "votes",
  /// "clusters", "looks" (it has a cluster, but its pose was given up) or "score".
  std::string lost(double min_score) const;
};

/// Follows true poses through the steps of recognise_scene, in one scene.
class Diagnoser {
 public:
  /// Keeps references to all, which must neither move nor change.
  Diagnoser(const io::HashLibrary& library, const kernels::RecognitionModel& scene,
            const jobs::RecognitionOptions& options, const engine::RunContext& context);

  /// Examines a pose of a model (index in the library), in coordinates of the files.
  Diagnosis diagnosis(std::int64_t model, const kernels::Similarity& truth) const;

 private:
  const io::HashLibrary& library_;
  const kernels::RecognitionModel& scene_;
  const jobs::RecognitionOptions& options_;
  jobs::PoseExaminer examiner_;
  jobs::TripletMatches matches_;
};

}  // namespace semigeo::recognition
