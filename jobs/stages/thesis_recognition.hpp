#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/run_context.hpp"
#include "io/library/hash_library.hpp"
#include "jobs/stages/recognise_scene.hpp"
#include "kernels/recognition/pose_clusters.hpp"
#include "kernels/recognition/thesis/thesis_hash.hpp"

namespace semigeo::jobs {

// Recognition as the thesis has it (4.5, 4.6, 5.9, 5.10), to compare with: all triplets of the
// strongest features in four hash tables, votes, clusters of poses. It looks at no surface.

struct ThesisRecognitionOptions {
  kernels::ThesisOptions hash;
  int level = 1;           ///< of models and scene; the thesis picks one for each (5.8)
  double survivors = 0.6;  ///< of the best score: models with less are not verified. Between 0.6
                           ///< and 0.7 in the tables of 6.4
  kernels::PoseTolerance clusters;
};

/// What the thesis' tables say of a model.
struct ThesisScore {
  std::array<double, kernels::kFeatureKinds> of_kind = {};  ///< thesis_score of each table
  double total = 0;                                         ///< their mean
  bool survives = false;                                    ///< the rest is of survivors only
  std::int64_t matches = 0;                                 ///< of all kinds
  std::int64_t cluster = 0;                                 ///< members of the largest
  kernels::Similarity pose;  ///< of that, model to scene, in coordinates of the files
};

/// The four hash tables of a library, in memory: 40 bytes a triplet, of 9,880 a model and kind at
/// most. The library should have features of torsion; kinds without features score 0.
class ThesisDatabase {
 public:
  /// Reads every model. Throws io::Error.
  ThesisDatabase(const io::HashLibrary& library, const ThesisRecognitionOptions& options,
                 const engine::RunContext& context);

  /// In the order of the library's models. The result does not depend on the number of threads.
  std::vector<ThesisScore> scores(const kernels::RecognitionModel& scene) const;

 private:
  struct Match;
  std::vector<Match> matches_of(const kernels::RecognitionModel& scene, int kind) const;
  void verify(std::size_t model, const kernels::RecognitionModel& scene,
              const std::vector<Match>& matches, ThesisScore& score) const;

  ThesisRecognitionOptions options_;
  const engine::RunContext& context_;
  std::vector<kernels::RecognitionModel> models_;
  std::vector<std::array<std::int64_t, kernels::kFeatureKinds>> counts_;  ///< chosen features
  std::vector<kernels::ThesisTable> tables_;                              ///< of each kind
};

/// As recognise_scene gives it: survivors by their largest cluster, which is their score, then the
/// others by the score of their votes. The thesis names one model: the first, if its cluster has
/// `min_score` members.
Recognition ranked(const std::vector<ThesisScore>& scores, const RecognitionOptions& options);

/// All of it, with the defaults. Builds the database anew.
Recognition thesis_recognition(const io::HashLibrary& library,
                               const kernels::RecognitionModel& scene,
                               const RecognitionOptions& options,
                               const engine::RunContext& context);

}  // namespace semigeo::jobs
