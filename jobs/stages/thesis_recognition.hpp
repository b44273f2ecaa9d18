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

// Recognition as in the thesis (4.5, 4.6, 5.9, 5.10), to compare with: all triplets of the
// strongest features in four hash tables, votes, clusters of poses. Surfaces are not compared.

/// Holds the parameters of recognition as in the thesis.
struct ThesisRecognitionOptions {
  kernels::ThesisOptions hash;
  int level = 1;  ///< Level of models and scene; the thesis picks one for each (5.8).
  /// Models with less than this share of the best score are not verified. It is between 0.6 and 0.7
  /// in the tables of 6.4.
  double survivors = 0.6;
  kernels::PoseTolerance clusters;
};

/// The score of a model, as in the tables of the thesis.
struct ThesisScore {
  std::array<double, kernels::kFeatureKinds> of_kind = {};  ///< thesis_score of each table.
  double total = 0;                                         ///< Mean of `of_kind`.
  bool survives = false;     ///< The members below are set for survivors only.
  std::int64_t matches = 0;  ///< Number of matches of all kinds.
  std::int64_t cluster = 0;  ///< Number of members of the largest cluster.
  /// Pose of that cluster, from model to scene, in coordinates of the files.
  kernels::Similarity pose;
};

/// The four hash tables of a library, in memory. A triplet takes 40 bytes; a model has at most
/// 9,880 triplets of each kind. The library should have features of torsion; kinds without features
/// score 0.
class ThesisDatabase {
 public:
  /// Reads every model. Throws io::Error if the library cannot be read.
  ThesisDatabase(const io::HashLibrary& library, const ThesisRecognitionOptions& options,
                 const engine::RunContext& context);

  /// Returns the scores in the order of the library's models. The result does not depend on the
  /// number of threads.
  std::vector<ThesisScore> scores(const kernels::RecognitionModel& scene) const;

 private:
  struct Match;
  std::vector<Match> matches_of(const kernels::RecognitionModel& scene, int kind) const;
  void verify(std::size_t model, const kernels::RecognitionModel& scene,
              const std::vector<Match>& matches, ThesisScore& score) const;

  ThesisRecognitionOptions options_;
  const engine::RunContext& context_;
  std::vector<kernels::RecognitionModel> models_;
  /// Number of chosen features.
  std::vector<std::array<std::int64_t, kernels::kFeatureKinds>> counts_;
  std::vector<kernels::ThesisTable> tables_;  ///< One table for each kind.
};

/// Returns the scores in the form of recognise_scene. Survivors come first, by the size of their
/// largest cluster, which is their score; the others follow by the score of their votes. One model
/// is named, as in the thesis: the first, if its cluster has at least `min_score` members.
Recognition ranked(const std::vector<ThesisScore>& scores, const RecognitionOptions& options);

/// Recognises a scene with the default options. It builds the database anew each time. Throws
/// io::Error if the library cannot be read.
Recognition thesis_recognition(const io::HashLibrary& library,
                               const kernels::RecognitionModel& scene,
                               const RecognitionOptions& options,
                               const engine::RunContext& context);

}  // namespace semigeo::jobs
