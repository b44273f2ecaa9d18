#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "jobs/stages/recognition_tuning.hpp"
#include "kernels/recognition/depth_map.hpp"
#include "kernels/recognition/overlap.hpp"
#include "kernels/recognition/pose_clusters.hpp"
#include "kernels/recognition/recognition_model.hpp"
#include "kernels/recognition/similarity.hpp"

namespace semigeo::jobs {

/// A pose of a model that is examined more and more closely. It leads from the model's own
/// coordinates to the scene's; origins are left out.
struct ExaminedPose {
  std::size_t listed = 0;  ///< Index of the model in the shortlist.
  kernels::Similarity pose;
  double cluster = 0;             ///< Weight of the matches that agree on the pose.
  double agreement = 0;           ///< Agreement of the surfaces at the last look.
  double support = 0;             ///< Weight of the matches that agree on the refined pose.
  kernels::Overlap overlap = {};  ///< How the model lies in the scene.
  double explained = 0;           ///< Share of the scene's samples that lie on the model.
  double score = 0;               ///< The larger one of both scores.
  double view_score = 0;          ///< view_score_of the pose, if the scene was seen from one place.
};

/// A model that may be in the scene.
struct ListedModel {
  std::int64_t model = 0;  ///< Index in HashLibrary::models.
  kernels::RecognitionModel record;
  kernels::PoseVotes votes;                 ///< The votes of triplets.
  std::optional<kernels::SampleTree> tree;  ///< Finds samples of the model, from step 6 on.
  std::vector<ExaminedPose> poses;
};

/// Returns the score of a measured pose. The result is 0 if nothing matches.
double score_of(const ExaminedPose& pose, const ScoreWeights& weights);

/// Returns the score of a measured pose in a scene that was seen from one place. What is hidden
/// does not count. The result is 0 if nothing matches.
double view_score_of(const ExaminedPose& pose, const ViewTuning& view);

/// Examines poses of models in one scene. Different models may be examined at the same time.
class PoseExaminer {
 public:
  /// Keeps references to both, which must neither move nor change.
  PoseExaminer(const kernels::RecognitionModel& scene, const RecognitionTuning& tuning);

  /// Returns the tree of the scene's samples.
  const kernels::SampleTree& scene_tree() const { return tree_; }

  /// Glances at all poses of a model, and keeps those that are worth a closer look.
  void glance(ListedModel& listed) const;

  /// Refines poses of a model roughly, and keeps the best different ones.
  void look_closer(ListedModel& listed, const RefinementEffort& effort) const;

  /// Refines a pose, and measures it in the whole scene. The model must have its tree.
  void verify(const ListedModel& listed, ExaminedPose& pose) const;

  /// Measures a pose against those samples of the scene that `used` does not mark; it may be
  /// empty. The model must have its tree.
  void measure(const ListedModel& listed, ExaminedPose& pose,
               std::span<const std::uint8_t> used) const;

  /// Returns the features of the scene whose nearest sample is not marked.
  kernels::OrientedFeatures features_off(std::span<const std::uint8_t> marked) const;

  /// Tells whether two poses of a model differ by less than a tolerance.
  static bool agree(const kernels::RecognitionModel& model, const kernels::Similarity& a,
                    const kernels::Similarity& b, const kernels::PoseTolerance& tolerance);

  /// Returns poses with a better score that a nearly symmetric model may have instead of this one.
  std::vector<ExaminedPose> better_symmetric_poses(const ListedModel& listed,
                                                   const ExaminedPose& pose) const;

  /// Returns the pose with the best score to which the model grows or shrinks along the surface
  /// that matches it. The result is empty unless the score is clearly better.
  std::optional<ExaminedPose> better_scaled_pose(const ListedModel& listed,
                                                 const ExaminedPose& pose) const;

 private:
  void measure_by(const MeasuredSamples& samples, const ListedModel& listed, ExaminedPose& pose,
                  std::span<const std::uint8_t> used) const;
  kernels::OverlapOptions close_overlap(const kernels::RecognitionModel& model,
                                        const kernels::Similarity& pose) const;
  double agreement(const kernels::RecognitionModel& model, const kernels::Similarity& pose,
                   const kernels::OverlapOptions& options, std::int64_t samples) const;
  void refine_roughly(const ListedModel& listed, ExaminedPose& pose) const;
  void leave_out_repeated(ListedModel& listed) const;

  const kernels::RecognitionModel& scene_;
  const RecognitionTuning& tuning_;
  kernels::SampleTree tree_;
  std::optional<kernels::DepthMap> depths_;  ///< Of a scene that was seen from one place.
};

}  // namespace semigeo::jobs
