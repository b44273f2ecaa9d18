#include "jobs/stages/pose_examiner.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace semigeo::jobs {
namespace {

using Eigen::Vector3d;
using kernels::RecognitionModel;
using kernels::Similarity;

/// Keeps the poses with the best agreement, and the heaviest clusters of the rest.
void keep(std::vector<ExaminedPose>& poses, std::size_t by_overlap, std::size_t by_weight) {
  std::ranges::stable_sort(poses, std::ranges::greater(), &ExaminedPose::agreement);
  if (poses.size() > by_overlap)
    std::stable_sort(
        poses.begin() + static_cast<std::ptrdiff_t>(by_overlap), poses.end(),
        [](const ExaminedPose& a, const ExaminedPose& b) { return a.cluster > b.cluster; });
  poses.resize(std::min(poses.size(), by_overlap + by_weight));
}

/// Returns the part of a score that says how well a pose fits where it matches.
double quality(const ExaminedPose& pose, double conflict, const ScoreWeights& weights) {
  const kernels::Overlap& o = pose.overlap;
  const double hold = o.stability + weights.hold_of_support * pose.support;
  const double held = hold / (hold + weights.half_held);
  return std::pow(held, weights.held) *
         std::pow(o.match / (o.match + conflict), weights.unopposed) *
         std::pow(o.closeness, weights.closeness);
}

/// Returns how much triplets speak for a pose, from 1/2 to 1.
double wanted(const ExaminedPose& pose, const ScoreWeights& weights) {
  return (weights.prior_support + pose.support) / (2 * weights.prior_support + pose.support);
}

}  // namespace

double score_of(const ExaminedPose& pose, const ScoreWeights& weights) {
  const kernels::Overlap& o = pose.overlap;
  if (o.match <= 0) return 0;
  const double either = o.match + pose.explained - o.match * pose.explained;
  return std::sqrt(o.match * either) * quality(pose, o.conflict, weights) *
         std::pow(pose.explained * wanted(pose, weights), weights.explained);
}

double view_score_of(const ExaminedPose& pose, const ViewTuning& view) {
  const double match = pose.overlap.match;
  const kernels::View& seen = pose.overlap.view;
  const double visible = seen.visible();
  if (match <= 0 || seen.there <= 0) return 0;
  const double enough = std::min(match / view.enough_match, 1.0);
  const double explained = std::min(pose.explained / view.enough_explained, 1.0);
  return std::min(match / visible, 1.0) * seen.there / visible * std::sqrt(enough) *
         std::pow(seen.there / (seen.there + seen.behind), view.hides_nothing) *
         quality(pose, seen.opposed, view.score) *
         std::pow(match / (match + pose.overlap.conflict), view.uncontradicted) *
         std::pow(explained * wanted(pose, view.score), view.score.explained);
}

PoseExaminer::PoseExaminer(const RecognitionModel& scene, const RecognitionTuning& tuning)
    : scene_(scene), tuning_(tuning), tree_(scene.samples) {
  if (scene.eye) depths_.emplace(scene.samples, *scene.eye);
}

void PoseExaminer::glance(ListedModel& listed) const {
  for (ExaminedPose& pose : listed.poses)
    pose.agreement = agreement(listed.record, pose.pose, tuning_.refinement.coarse_overlap,
                               tuning_.glances.samples);
  keep(listed.poses, tuning_.glances.poses_by_overlap, tuning_.glances.poses_by_weight);
}

void PoseExaminer::look_closer(ListedModel& listed, const RefinementEffort& effort) const {
  const RecognitionModel& model = listed.record;
  const RefinementTuning& tuning = tuning_.refinement;
  for (ExaminedPose& pose : listed.poses)
    pose.agreement = agreement(model, pose.pose, tuning.coarse_overlap, tuning.coarse_samples);
  keep(listed.poses, effort.coarse, tuning.poses_by_weight);
  for (ExaminedPose& pose : listed.poses) refine_roughly(listed, pose);
  leave_out_repeated(listed);
  for (ExaminedPose& pose : listed.poses)
    pose.agreement =
        agreement(model, pose.pose, close_overlap(model, pose.pose), tuning.middle_samples);
  keep(listed.poses, effort.refined, 0);
}

void PoseExaminer::verify(const ListedModel& listed, ExaminedPose& pose) const {
  const RecognitionModel& model = listed.record;
  pose.pose = kernels::refine_pose(model.samples, model.diagonal, pose.pose, tree_,
                                   tuning_.refinement.fine);
  pose.support = listed.votes.support(pose.pose, tuning_.clusters.support);
  measure(listed, pose, {});
}

void PoseExaminer::measure(const ListedModel& listed, ExaminedPose& pose,
                           std::span<const std::uint8_t> used) const {
  measure_by(tuning_.measurement.samples, listed, pose, used);
}

void PoseExaminer::measure_by(const MeasuredSamples& samples, const ListedModel& listed,
                              ExaminedPose& pose, std::span<const std::uint8_t> used) const {
  const RecognitionModel& model = listed.record;
  kernels::OverlapOptions options = close_overlap(model, pose.pose);
  options.stability = true;
  options.depths = depths_ ? &*depths_ : nullptr;
  pose.overlap = kernels::overlap(model.samples, model.diagonal, pose.pose, tree_, options,
                                  samples.of_model, used);
  const auto marks = kernels::samples_on_model(*listed.tree, model.diagonal, pose.pose,
                                               scene_.samples, options, samples.of_scene, used);
  pose.explained = static_cast<double>(std::ranges::count(marks, 1)) /
                   static_cast<double>(std::max<std::size_t>(marks.size(), 1));
  pose.score = score_of(pose, tuning_.score);
  if (!depths_) return;
  pose.view_score = view_score_of(pose, tuning_.view);
  pose.score = std::max(pose.score, tuning_.view.weight * pose.view_score);
}

std::vector<ExaminedPose> PoseExaminer::better_symmetric_poses(const ListedModel& listed,
                                                               const ExaminedPose& pose) const {
  const RecognitionModel& model = listed.record;
  const SymmetricPoseTuning& tuning = tuning_.symmetric_poses;
  const auto look = [&](const Similarity& similarity) {
    return agreement(model, similarity, tuning.overlap, tuning.samples);
  };
  const double enough = tuning.enough * look(pose.pose);
  std::vector<ExaminedPose> tried;
  for (const Similarity& other : kernels::symmetric_poses(model.samples, model.diagonal, pose.pose,
                                                          tree_, close_overlap(model, pose.pose),
                                                          tuning_.measurement.samples.of_model))
    if (const double agreement = look(other); agreement > enough)
      tried.push_back(
          {.listed = pose.listed, .pose = other, .cluster = pose.cluster, .agreement = agreement});
  keep(tried, tuning.per_pose, 0);
  for (ExaminedPose& other : tried) {
    refine_roughly(listed, other);
    verify(listed, other);
  }
  std::erase_if(tried, [&](const ExaminedPose& other) { return other.score <= pose.score; });
  return tried;
}

std::optional<ExaminedPose> PoseExaminer::better_scaled_pose(const ListedModel& listed,
                                                             const ExaminedPose& pose) const {
  const RecognitionModel& model = listed.record;
  const ScaledPoseTuning& tuning = tuning_.scaled_poses;
  const auto motion = kernels::free_scaling(model.samples, model.diagonal, pose.pose, tree_,
                                            close_overlap(model, pose.pose),
                                            tuning_.measurement.samples.of_model, tuning.most_held);
  if (!motion) return std::nullopt;
  ExaminedPose best = pose;
  measure_by(tuning.samples, listed, best, {});
  double way = 0;
  const auto look = [&](double log_scale) {
    ExaminedPose tried = pose;
    tried.pose = motion->scaled(log_scale) * pose.pose;
    measure_by(tuning.samples, listed, tried, {});
    if (tried.score <= best.score) return;
    best = tried;
    way = log_scale;
  };
  const auto look_about = [&](double middle, double step) {
    look(middle - step);
    look(middle + step);
  };
  for (const double step : tuning.ways) look_about(0, step);
  for (const double step : tuning.finer) look_about(way, step);
  if (way == 0) return std::nullopt;
  verify(listed, best);
  if (best.score <= tuning.gain * pose.score) return std::nullopt;
  return best;
}

kernels::OrientedFeatures PoseExaminer::features_off(std::span<const std::uint8_t> marked) const {
  kernels::OrientedFeatures result = scene_.features;
  std::erase_if(result.features, [&](const kernels::OrientedFeature& feature) {
    const std::int64_t near = tree_.nearest(feature.position, scene_.diagonal);
    return near >= 0 && marked[near] != 0;
  });
  return result;
}

/// Returns the tolerance within which the surfaces match in a pose that is right.
kernels::OverlapOptions PoseExaminer::close_overlap(const RecognitionModel& model,
                                                    const Similarity& pose) const {
  const MeasurementTuning& tuning = tuning_.measurement;
  kernels::OverlapOptions result;
  const std::vector<float>& of_scene = scene_.features.level_scale;
  const std::vector<float>& of_model = model.features.level_scale;
  if (of_scene.empty() || of_model.empty()) return result;
  const double edge = std::max<double>(of_scene.front(), of_model.front() * pose.scale);
  result.match = std::clamp(tuning.match_edges * edge / (model.diagonal * pose.scale), result.match,
                            tuning.widest_match);
  return result;
}

double PoseExaminer::agreement(const RecognitionModel& model, const Similarity& pose,
                               const kernels::OverlapOptions& options, std::int64_t samples) const {
  return kernels::overlap(model.samples, model.diagonal, pose, tree_, options, samples).agreement();
}

void PoseExaminer::refine_roughly(const ListedModel& listed, ExaminedPose& pose) const {
  const RecognitionModel& model = listed.record;
  pose.pose = kernels::refine_pose(model.samples, model.diagonal, pose.pose, tree_,
                                   tuning_.refinement.rough);
}

bool PoseExaminer::agree(const RecognitionModel& model, const Similarity& a, const Similarity& b,
                         const kernels::PoseTolerance& tolerance) {
  const Vector3d centre = model.centre.cast<double>();
  return std::abs(std::log(a.scale / b.scale)) < tolerance.log_scale &&
         (a.apply(centre) - b.apply(centre)).norm() <
             tolerance.distance * model.diagonal * b.scale &&
         kernels::rotation_between(a.rotation, b.rotation) < tolerance.angle;
}

/// Keeps the first of several poses that have become the same.
void PoseExaminer::leave_out_repeated(ListedModel& listed) const {
  std::vector<ExaminedPose> different;
  for (const ExaminedPose& pose : listed.poses)
    if (std::ranges::none_of(different, [&](const ExaminedPose& d) {
          return agree(listed.record, d.pose, pose.pose, tuning_.refinement.same);
        }))
      different.push_back(pose);
  listed.poses = std::move(different);
}

}  // namespace semigeo::jobs
