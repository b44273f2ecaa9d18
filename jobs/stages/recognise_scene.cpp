#include "jobs/stages/recognise_scene.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>
#include <utility>

#include "jobs/stages/match_triplets.hpp"
#include "jobs/stages/match_votes.hpp"
#include "jobs/stages/pose_examiner.hpp"
#include "kernels/recognition/curvature_frame.hpp"
#include "kernels/recognition/feature_pair.hpp"

namespace semigeo::jobs {
namespace {

using kernels::RecognitionModel;
using kernels::Similarity;

/// Recognises one scene. A Recogniser is used once.
class Recogniser {
 public:
  Recogniser(const io::HashLibrary& library, const RecognitionModel& scene,
             const RecognitionOptions& options, const engine::RunContext& context)
      : library_(library),
        scene_(scene),
        options_(options),
        tuning_(options.tuning),
        context_(context),
        examiner_(scene, options.tuning) {}

  Recognition run() {
    look_up(scene_.features, tuning_.look_up);
    result_.scene_triplets = matches_.scene_triplets;
    result_.matches = static_cast<std::int64_t>(matches_.matches.size());
    votes_ = matches_.votes;
    shortlist();
    most_matches_ = tuning_.shortlist.most_matches;
    examine();
    find_objects();
    if (scene_.eye) {
      look_again();
      look_at_curvature();
    }
    rank();
    return std::move(result_);
  }

 private:
  const RefinementEffort& effort() const {
    if (scene_.eye) return tuning_.refinement.of_view;
    return pairs_.empty() ? tuning_.refinement.usual : tuning_.refinement.of_pairs;
  }

  template <typename Body>
  void for_each(std::size_t count, const Body& body) {
    context_.workers.for_blocks(static_cast<std::int64_t>(count), 1, [&](engine::IndexRange range) {
      for (auto i = range.begin; i < range.end; ++i) body(static_cast<std::size_t>(i));
    });
  }

  /// Matches triplets of features of the scene with the library, and makes pairs if there are few
  /// triplets.
  void look_up(kernels::OrientedFeatures features, const LookUpTuning& tuning) {
    features_ = std::move(features);
    const std::vector<kernels::Triplet> triplets =
        kernels::local_triplets(features_, scene_triplet_options(tuning));
    matches_ = match_triplets(library_, triplets, tuning, context_);
    pairs_.clear();
    if (matches_.scene_triplets < tuning_.pairs.few_triplets)
      pairs_ = kernels::local_pairs(features_, scene_pair_options(tuning_));
  }

  /// Finds poses of all listed models, and examines the best of them until they have scores.
  void examine() {
    for_each(shortlist_.size(), [this](std::size_t i) {
      find_poses(i);
      examiner_.glance(shortlist_[i]);
    });
    choose_models();
    for_each(shortlist_.size(),
             [this](std::size_t i) { examiner_.look_closer(shortlist_[i], effort()); });
    verify_best();
  }

  /// Refines and measures the best poses of all models.
  void verify_best() {
    choose_poses();
    for_each(poses_.size(),
             [this](std::size_t i) { examiner_.verify(shortlist_[poses_[i].listed], poses_[i]); });
    poses_ = best_different(tuning_.refinement.same, poses_.size());
    try_symmetric_poses();
    if (scene_.eye) try_scaled_poses();
    std::erase_if(
        poses_, [this](const ExaminedPose& pose) { return !options_.scale.has(pose.pose.scale); });
    std::ranges::stable_sort(poses_, std::ranges::greater(), &ExaminedPose::score);
  }

  /// Looks once more at what the objects leave of a scene that was seen from one place: with more
  /// triangles of its features alone.
  void look_again() {
    if (!enough_is_left()) return;
    const SecondLookTuning& tuning = tuning_.second_look;
    LookUpTuning look = tuning_.look_up;
    look.most_triangles = tuning.most_triangles;
    look_up(examiner_.features_off(used_), look);
    most_matches_ = tuning.most_matches;
    const std::vector<ExaminedPose> before = std::exchange(poses_, {});
    examine();
    find_objects_again(before);
  }

  /// Looks a third time at what is left of such a scene: at its curvature, which tells where models
  /// without features may be. Only models that were not found are tried.
  void look_at_curvature() {
    if (!enough_is_left()) return;
    const std::vector<kernels::CurvatureFrame> frames =
        kernels::curvature_frames(examiner_.scene_tree(), tuning_.third_look.of_scene, used_);
    if (frames.empty()) return;
    const std::vector<std::size_t> missing = list_missing();
    for (ListedModel& listed : shortlist_) listed.poses.clear();
    pairs_.clear();
    for_each(missing.size(), [&](std::size_t i) {
      find_poses_by_curvature(missing[i], frames);
      examiner_.glance(shortlist_[missing[i]]);
      examiner_.look_closer(shortlist_[missing[i]], effort());
    });
    const std::vector<ExaminedPose> before = std::exchange(poses_, {});
    verify_best();
    find_objects_again(before);
  }

  /// Tells whether the objects leave enough of the scene for another look.
  bool enough_is_left() const {
    const auto left = static_cast<double>(std::ranges::count(used_, 0));
    return left >= tuning_.second_look.least_left * static_cast<double>(used_.size());
  }

  /// Finds objects by the poses of this look and of those before it.
  void find_objects_again(const std::vector<ExaminedPose>& before) {
    poses_.insert(poses_.end(), before.begin(), before.end());
    std::ranges::stable_sort(poses_, std::ranges::greater(), &ExaminedPose::score);
    find_objects();
  }

  /// Lists the models that were not found, those with the fewest features first, and returns their
  /// places in the list.
  std::vector<std::size_t> list_missing() {
    std::vector<std::int64_t> missing;
    for (std::int64_t i = 0; i < std::ssize(library_.models()); ++i)
      if (std::ranges::find(result_.objects, i, &Candidate::model) == result_.objects.end())
        missing.push_back(i);
    std::ranges::stable_sort(missing, {},
                             [this](std::int64_t i) { return library_.models()[i].features; });
    missing.resize(std::min(missing.size(), tuning_.third_look.most_models));
    std::vector<std::size_t> places;
    for (const std::int64_t model : missing) {
      const auto at = std::ranges::find(shortlist_, model, &ListedModel::model);
      places.push_back(static_cast<std::size_t>(at - shortlist_.begin()));
      if (at == shortlist_.end()) shortlist_.emplace_back().model = model;
    }
    return places;
  }

  /// Finds the poses on which frames of curvature of the listed model and the scene agree.
  void find_poses_by_curvature(std::size_t index,
                               const std::vector<kernels::CurvatureFrame>& of_scene) {
    const ThirdLookTuning& tuning = tuning_.third_look;
    ListedModel& listed = shortlist_[index];
    if (listed.record.samples.points.empty()) listed.record = library_.read_model(listed.model);
    const RecognitionModel& model = listed.record;
    if (!listed.tree) listed.tree.emplace(model.samples);
    std::vector<kernels::PoseVote> votes = kernels::votes_of_frames(
        of_scene, kernels::curvature_frames(*listed.tree, tuning.of_model), tuning.ratio_tolerance);
    const ScaleRange scales = options_.scale.widened();
    std::erase_if(votes,
                  [&](const kernels::PoseVote& vote) { return !scales.has(vote.pose.scale); });
    const kernels::PoseVotes together(votes, model.centre.cast<double>(), model.diagonal);
    for (const kernels::PoseCluster& cluster : together.clusters(tuning.clusters))
      listed.poses.push_back(
          {.listed = index, .pose = cluster.pose, .cluster = tuning.vote_weight * cluster.weight});
  }

  /// Lists models that got votes. Those come first that got the most beyond what chance gives a
  /// model with so many triplets, in standard deviations. Models without votes may have pairs.
  void shortlist() {
    const std::vector<io::ModelInfo>& models = library_.models();
    const double votes = std::accumulate(matches_.votes.begin(), matches_.votes.end(), 0.0);
    const auto triplets = static_cast<double>(library_.posting_count());
    std::vector<double> surplus(models.size());
    std::vector<std::int64_t> order;
    for (std::size_t i = 0; i < models.size(); ++i) {
      if (matches_.votes[i] <= 0 && pairs_.empty()) continue;
      const double chance = votes * static_cast<double>(models[i].triplets) / triplets;
      if (chance > 0) surplus[i] = (matches_.votes[i] - chance) / std::sqrt(chance);
      order.push_back(static_cast<std::int64_t>(i));
    }
    std::ranges::stable_sort(order, std::ranges::greater(),
                             [&](std::int64_t i) { return surplus[i]; });
    order.resize(std::min(order.size(), tuning_.shortlist.most_models));
    shortlist_.resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) shortlist_[i].model = order[i];
  }

  /// Finds the poses on which triplets of the listed model agree, and those on which pairs do.
  void find_poses(std::size_t index) {
    ListedModel& listed = shortlist_[index];
    if (listed.record.samples.points.empty()) listed.record = library_.read_model(listed.model);
    listed.poses.clear();
    const RecognitionModel& model = listed.record;
    const std::size_t most =
        std::min(most_matches_, tuning_.shortlist.most_matches_together / shortlist_.size());
    listed.votes = votes_of_triplets(
        weightiest_matches(matches_, listed.model, most, match_filter(model)), model, features_);
    add_clusters(listed.votes, 1, index);
    if (pairs_.empty() || index >= tuning_.pairs.most_models) return;
    add_clusters(votes_of_pairs(pairs_, model, most_matches_, options_.scale.widened()),
                 tuning_.pairs.vote_weight, index);
  }

  /// Returns what leaves matches out whose scale cannot be right, or nothing if any scale can.
  MatchFilter match_filter(const RecognitionModel& model) const {
    if (options_.scale.is_any()) return {};
    return [&model, this](const TripletMatch& match) {
      return options_.scale.widened().has(scale_of(match, model, features_));
    };
  }

  void add_clusters(const kernels::PoseVotes& votes, double weight, std::size_t index) {
    const ClusterTuning& tuning = tuning_.clusters;
    kernels::ClusterOptions options;
    if (scene_.eye) options.seeds = tuning.seeds_of_view;
    if (shortlist_.size() > tuning.few_models)
      options = {.seeds = tuning.seeds_of_many, .most = tuning.most_of_many};
    for (const kernels::PoseCluster& cluster : votes.clusters(options))
      shortlist_[index].poses.push_back(
          {.listed = index, .pose = cluster.pose, .cluster = weight * cluster.weight});
  }

  /// Leaves the poses of those models only that are worth a closer look, if there are many.
  void choose_models() {
    const std::size_t by_overlap = tuning_.glances.models_by_overlap;
    const std::size_t chosen = by_overlap + tuning_.glances.models_by_weight;
    if (shortlist_.size() <= chosen) return;
    const auto most = [](const ListedModel& listed, double ExaminedPose::*value) {
      double best = 0;
      for (const ExaminedPose& pose : listed.poses) best = std::max(best, pose.*value);
      return best;
    };
    std::vector<std::size_t> order(shortlist_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto sort_by = [&](std::size_t first, double ExaminedPose::*value) {
      std::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(first), order.end(),
                       [&](std::size_t a, std::size_t b) {
                         return most(shortlist_[a], value) > most(shortlist_[b], value);
                       });
    };
    sort_by(0, &ExaminedPose::agreement);
    sort_by(by_overlap, &ExaminedPose::cluster);
    for (std::size_t i = chosen; i < order.size(); ++i) shortlist_[order[i]].poses.clear();
  }

  /// Chooses the poses of all models that are refined.
  void choose_poses() {
    for (ListedModel& listed : shortlist_)
      poses_.insert(poses_.end(), listed.poses.begin(), listed.poses.end());
    std::ranges::stable_sort(poses_, std::ranges::greater(), &ExaminedPose::agreement);
    poses_.resize(std::min(poses_.size(), effort().together));
    std::vector<std::uint8_t> wanted(shortlist_.size());
    for (const ExaminedPose& pose : poses_) wanted[pose.listed] = 1;
    for_each(shortlist_.size(), [&](std::size_t i) {
      if (wanted[i] != 0 && !shortlist_[i].tree)
        shortlist_[i].tree.emplace(shortlist_[i].record.samples);
    });
  }

  /// Returns the poses with the best scores, at most `most`. Poses of a model that agree count as
  /// one.
  std::vector<ExaminedPose> best_different(const kernels::PoseTolerance& tolerance,
                                           std::size_t most) {
    std::ranges::stable_sort(poses_, std::ranges::greater(), &ExaminedPose::score);
    std::vector<ExaminedPose> different;
    for (const ExaminedPose& pose : poses_) {
      if (different.size() == most) break;
      const RecognitionModel& model = shortlist_[pose.listed].record;
      if (std::ranges::none_of(different, [&](const ExaminedPose& better) {
            return better.listed == pose.listed &&
                   PoseExaminer::agree(model, better.pose, pose.pose, tolerance);
          }))
        different.push_back(pose);
    }
    return different;
  }

  /// Adds what `better(model, pose)` returns for each of some poses.
  template <typename Better>
  void add_better(const std::vector<ExaminedPose>& tried, const Better& better) {
    std::vector<std::vector<ExaminedPose>> found(tried.size());
    for_each(tried.size(), [&](std::size_t i) {
      for (const ExaminedPose& pose : better(shortlist_[tried[i].listed], tried[i]))
        found[i].push_back(pose);
    });
    for (const std::vector<ExaminedPose>& of_pose : found)
      poses_.insert(poses_.end(), of_pose.begin(), of_pose.end());
  }

  /// Adds better poses of models that are nearly symmetric.
  void try_symmetric_poses() {
    const SymmetricPoseTuning& tuning = tuning_.symmetric_poses;
    add_better(best_different(tuning.one_place, tuning.tried),
               [this](const ListedModel& listed, const ExaminedPose& pose) {
                 return examiner_.better_symmetric_poses(listed, pose);
               });
  }

  /// Adds better poses of models whose size only their rims tell.
  void try_scaled_poses() {
    const ScaledPoseTuning& tuning = tuning_.scaled_poses;
    std::vector<ExaminedPose> tried = best_different(tuning_.refinement.same, tuning.tried);
    std::erase_if(tried, [&](const ExaminedPose& pose) { return pose.score < tuning.least_score; });
    add_better(tried, [this](const ListedModel& listed, const ExaminedPose& pose) {
      const std::optional<ExaminedPose> better = examiner_.better_scaled_pose(listed, pose);
      return better ? std::vector{*better} : std::vector<ExaminedPose>();
    });
  }

  Candidate candidate_of(const ExaminedPose& pose) const {
    const ListedModel& listed = shortlist_[pose.listed];
    Candidate candidate;
    candidate.model = listed.model;
    candidate.votes = votes_[listed.model];
    candidate.cluster = pose.cluster;
    candidate.support = pose.support;
    candidate.closeness = pose.overlap.closeness;
    candidate.match = pose.overlap.match;
    candidate.conflict = pose.overlap.conflict;
    candidate.stability = pose.overlap.stability;
    candidate.explained = pose.explained;
    candidate.score = pose.score;
    if (scene_.eye) candidate.view = pose.overlap.view;
    candidate.view_score = pose.view_score;
    const Similarity from_file = {.translation = -listed.record.origin};
    const Similarity to_file = {.translation = scene_.origin};
    candidate.pose = to_file * pose.pose * from_file;
    return candidate;
  }

  /// Ranks models by their best poses.
  void rank() {
    std::vector<std::uint8_t> seen(shortlist_.size());
    for (const ExaminedPose& pose : poses_)
      if (std::exchange(seen[pose.listed], 1) == 0) result_.ranking.push_back(candidate_of(pose));
  }

  /// Finds the best object, then the best one on what of the scene the first leaves, and so on.
  void find_objects() {
    result_.objects.clear();
    used_.assign(scene_.samples.points.size(), 0);
    std::vector<ExaminedPose> left = poses_;
    while (true) {
      std::erase_if(left,
                    [this](const ExaminedPose& pose) { return pose.score < options_.min_score; });
      if (left.empty() || left.front().score <= 0) return;
      const ExaminedPose best = left.front();
      result_.objects.push_back(candidate_of(best));
      const ListedModel& listed = shortlist_[best.listed];
      const auto marks =
          kernels::samples_on_model(*listed.tree, listed.record.diagonal, best.pose, scene_.samples,
                                    tuning_.objects.used, static_cast<std::int64_t>(used_.size()));
      for (std::size_t i = 0; i < marks.size(); ++i) used_[i] |= marks[i];
      left.erase(left.begin());
      for_each(left.size(), [&](std::size_t i) {
        examiner_.measure(shortlist_[left[i].listed], left[i], used_);
      });
      std::ranges::stable_sort(left, std::ranges::greater(), &ExaminedPose::score);
    }
  }

  const io::HashLibrary& library_;
  const RecognitionModel& scene_;
  const RecognitionOptions& options_;
  const RecognitionTuning& tuning_;
  const engine::RunContext& context_;
  PoseExaminer examiner_;
  kernels::OrientedFeatures features_;  ///< Features of the scene that are looked up.
  TripletMatches matches_;
  std::size_t most_matches_ = 0;             ///< Largest number of matches of one model.
  std::vector<double> votes_;                ///< Votes of each model in the whole scene.
  std::vector<std::uint8_t> used_;           ///< Marks samples of the scene that lie on objects.
  std::vector<kernels::FeaturePair> pairs_;  ///< Pairs of the scene, if it has few triplets.
  std::deque<ListedModel> shortlist_;        ///< A deque, because trees refer to its records.
  std::vector<ExaminedPose> poses_;
  Recognition result_;
};

}  // namespace

Recognition recognise_scene(const io::HashLibrary& library, const RecognitionModel& scene,
                            const RecognitionOptions& options, const engine::RunContext& context) {
  return Recogniser(library, scene, options, context).run();
}

}  // namespace semigeo::jobs
