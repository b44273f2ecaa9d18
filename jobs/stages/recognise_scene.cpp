#include "jobs/stages/recognise_scene.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "jobs/stages/match_triplets.hpp"
#include "kernels/feature_triangle.hpp"
#include "kernels/overlap.hpp"
#include "kernels/pose_clusters.hpp"

namespace semigeo::jobs {
namespace {

using Eigen::Vector3d;
using kernels::RecognitionModel;
using kernels::Similarity;

/// A scene's feature may be a little out of the band that the model's is in.
constexpr double kBandSlack = 1.075;
constexpr std::size_t kShortlist = 400;            ///< models with the best votes
constexpr std::size_t kMostMatches = 8000;         ///< of one model, the weightiest;
constexpr std::size_t kMatchesTogether = 600'000;  ///< if there are many models, fewer of each

// Each look at a pose costs more than the one before, and fewer poses are looked at.
constexpr std::int64_t kGlanceSamples = 60;
constexpr std::size_t kGlanced = 40;  ///< of one model, go on
constexpr std::size_t kFewModels = 40;
constexpr int kFewClusters = 24;             ///< of each of more models than that; and of these
constexpr std::size_t kModelsByGlance = 40;  ///< go on: those that look best,
constexpr std::size_t kModelsByWeight = 30;  ///< and those of the heaviest clusters besides
constexpr std::int64_t kCoarseSamples = 200;
constexpr std::size_t kCoarseByOverlap = 5;  ///< of one model, are refined a little
constexpr std::size_t kCoarseByWeight = 3;   ///< besides, whatever they look like
constexpr std::int64_t kMiddleSamples = 400;
constexpr std::size_t kRefinedPerModel = 4;
constexpr std::size_t kRefinedTogether = 60;
constexpr std::int64_t kFineSamples = 2000;
constexpr std::int64_t kExplainedSamples = 4000;

constexpr kernels::OverlapOptions kCoarse = {.match = 0.02, .conflict = 0.06, .min_cosine = 0.6};
/// Noise and triangulation grow with the edges: of coarse scans the surfaces that are one lie
/// farther apart. In mean edge lengths of the coarser one, and at most so many diagonals.
constexpr double kMatchEdges = 0.5;
constexpr double kWidestMatch = 0.02;
constexpr kernels::PoseTolerance kSupport = {.log_scale = 0.15, .distance = 0.06, .angle = 0.25};

kernels::TripletOptions scene_triplets() {
  kernels::TripletOptions options;
  options.nearest /= kBandSlack;
  options.farthest *= kBandSlack;
  options.min_height *= 0.9;
  options.every_order = true;
  return options;
}

/// A pose of a model, more and more closely looked at. Poses are from the model's own coordinates
/// to the scene's, origins apart.
struct Pose {
  std::size_t listed = 0;  ///< in the shortlist
  Similarity pose;
  double cluster = 0;
  double coarse = 0;
  double support = 0;
  kernels::Overlap overlap = {};
  double explained = 0;
  double score = 0;
};

struct Listed {
  std::int64_t model = 0;
  RecognitionModel record;
  kernels::PoseVotes votes;
  std::optional<kernels::SampleTree> tree;
  std::vector<Pose> poses;
};

class Recogniser {
 public:
  Recogniser(const io::HashLibrary& library, const RecognitionModel& scene,
             const RecognitionOptions& options, const engine::RunContext& context)
      : library_(library),
        scene_(scene),
        options_(options),
        context_(context),
        tree_(scene.samples) {}

  Recognition run() {
    const std::vector<kernels::Triplet> triplets =
        kernels::local_triplets(scene_.features, scene_triplets());
    matches_ = match_triplets(library_, triplets, {}, context_);
    result_.scene_triplets = matches_.scene_triplets;
    result_.matches = static_cast<std::int64_t>(matches_.matches.size());
    shortlist();
    for_each(shortlist_.size(), [this](std::size_t i) { find_poses(i); });
    choose_models();
    for_each(shortlist_.size(), [this](std::size_t i) { look_closer(shortlist_[i]); });
    choose_poses();
    for_each(poses_.size(), [this](std::size_t i) { verify(poses_[i]); });
    rank();
    find_objects();
    return std::move(result_);
  }

 private:
  template <typename Body>
  void for_each(std::size_t count, const Body& body) {
    context_.workers.for_blocks(static_cast<std::int64_t>(count), 1, [&](engine::IndexRange range) {
      for (auto i = range.begin; i < range.end; ++i) body(static_cast<std::size_t>(i));
    });
  }

  /// Models that got votes, those first that got the most beyond what chance gives a model with so
  /// many triplets, in standard deviations.
  void shortlist() {
    const std::vector<io::ModelInfo>& models = library_.models();
    const double votes = std::accumulate(matches_.votes.begin(), matches_.votes.end(), 0.0);
    const auto triplets = static_cast<double>(library_.posting_count());
    std::vector<double> surplus(models.size());
    std::vector<std::int64_t> order;
    for (std::size_t i = 0; i < models.size(); ++i) {
      if (matches_.votes[i] <= 0) continue;
      const double chance = votes * static_cast<double>(models[i].triplets) / triplets;
      surplus[i] = (matches_.votes[i] - chance) / std::sqrt(chance);
      order.push_back(static_cast<std::int64_t>(i));
    }
    std::ranges::stable_sort(order, std::ranges::greater(),
                             [&](std::int64_t i) { return surplus[i]; });
    order.resize(std::min(order.size(), kShortlist));
    shortlist_.resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) shortlist_[i].model = order[i];
  }

  void find_poses(std::size_t index) {
    Listed& listed = shortlist_[index];
    listed.record = library_.read_model(listed.model);
    const RecognitionModel& model = listed.record;
    std::vector<TripletMatch> matches(matches_.matches.begin() + matches_.first[listed.model],
                                      matches_.matches.begin() + matches_.first[listed.model + 1]);
    const std::size_t most = std::min(kMostMatches, kMatchesTogether / shortlist_.size());
    if (matches.size() > most) {
      const auto heavier = [](const TripletMatch& a, const TripletMatch& b) {
        return std::tie(b.weight, a.triangle, a.model_corners) <
               std::tie(a.weight, b.triangle, b.model_corners);
      };
      std::ranges::nth_element(matches, matches.begin() + static_cast<std::ptrdiff_t>(most),
                               heavier);
      matches.resize(most);
      std::ranges::sort(matches, heavier);
    }
    // Here a match shares its triangle with others of this model only: what agrees on a pose must
    // not depend on how many models the library has.
    std::ranges::stable_sort(matches, {}, &TripletMatch::triangle);
    std::vector<kernels::PoseVote> votes;
    votes.reserve(matches.size());
    for (auto first = matches.begin(); first != matches.end();) {
      const auto last = std::find_if(first, matches.end(), [&](const TripletMatch& match) {
        return match.triangle != first->triangle;
      });
      const double weight = 1.0 / static_cast<double>(last - first);
      for (; first != last; ++first)
        votes.push_back({kernels::similarity_between(
                             kernels::feature_triangle(model.features, first->model_corners),
                             kernels::feature_triangle(scene_.features, first->scene_corners)),
                         weight});
    }
    listed.votes = kernels::PoseVotes(votes, model.centre.cast<double>(), model.diagonal);
    kernels::ClusterOptions clusters;
    if (shortlist_.size() > kFewModels) clusters.most = kFewClusters;
    if (shortlist_.size() > kFewModels) clusters.seeds = 4 * kFewClusters;
    for (const kernels::PoseCluster& cluster : listed.votes.clusters(clusters))
      listed.poses.push_back({.listed = index, .pose = cluster.pose, .cluster = cluster.weight});
    look(listed, kGlanceSamples, coarse);
    keep(listed.poses, kGlanced, kCoarseByWeight);
  }

  /// Of many models only those that are worth a closer look.
  void choose_models() {
    if (shortlist_.size() <= kModelsByGlance + kModelsByWeight) return;
    const auto most = [](const Listed& listed, double Pose::*value) {
      double best = 0;
      for (const Pose& pose : listed.poses) best = std::max(best, pose.*value);
      return best;
    };
    std::vector<std::size_t> order(shortlist_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto sort_by = [&](std::size_t first, double Pose::*value) {
      std::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(first), order.end(),
                       [&](std::size_t a, std::size_t b) {
                         return most(shortlist_[a], value) > most(shortlist_[b], value);
                       });
    };
    sort_by(0, &Pose::coarse);
    sort_by(kModelsByGlance, &Pose::cluster);
    for (std::size_t i = kModelsByGlance + kModelsByWeight; i < order.size(); ++i)
      shortlist_[order[i]].poses.clear();
  }

  void look_closer(Listed& listed) {
    const RecognitionModel& model = listed.record;
    look(listed, kCoarseSamples, coarse);
    keep(listed.poses, kCoarseByOverlap, kCoarseByWeight);
    for (Pose& pose : listed.poses)
      pose.pose = kernels::refined(model.samples, model.diagonal, pose.pose, tree_,
                                   {.reach = {0.08, 0.05}, .iterations = 3, .count = 200});
    leave_out_repeated(listed);
    look(listed, kMiddleSamples, [&](const Pose& pose) { return close(model, pose.pose); });
    keep(listed.poses, kRefinedPerModel, 0);
  }

  /// As close as a pose of the model can be expected to lie.
  kernels::OverlapOptions close(const RecognitionModel& model, const Similarity& pose) const {
    kernels::OverlapOptions result;
    const std::vector<float>& of_scene = scene_.features.level_scale;
    const std::vector<float>& of_model = model.features.level_scale;
    if (of_scene.empty() || of_model.empty()) return result;
    const double edge = std::max<double>(of_scene.front(), of_model.front() * pose.scale);
    result.match =
        std::clamp(kMatchEdges * edge / (model.diagonal * pose.scale), result.match, kWidestMatch);
    return result;
  }

  static kernels::OverlapOptions coarse(const Pose& /*pose*/) { return kCoarse; }

  template <typename OptionsOf>
  void look(Listed& listed, std::int64_t samples, const OptionsOf& options_of) const {
    const RecognitionModel& model = listed.record;
    for (Pose& pose : listed.poses)
      pose.coarse = kernels::overlap(model.samples, model.diagonal, pose.pose, tree_,
                                     options_of(pose), samples)
                        .agreement();
  }

  /// The best by overlap, and the heaviest clusters of the rest.
  static void keep(std::vector<Pose>& poses, std::size_t by_overlap, std::size_t by_weight) {
    std::ranges::stable_sort(poses, std::ranges::greater(), &Pose::coarse);
    if (poses.size() > by_overlap)
      std::stable_sort(poses.begin() + static_cast<std::ptrdiff_t>(by_overlap), poses.end(),
                       [](const Pose& a, const Pose& b) { return a.cluster > b.cluster; });
    poses.resize(std::min(poses.size(), by_overlap + by_weight));
  }

  /// Of poses that have become one, the first stays.
  static void leave_out_repeated(Listed& listed) {
    const RecognitionModel& model = listed.record;
    const Vector3d centre = model.centre.cast<double>();
    std::vector<Pose> different;
    for (const Pose& pose : listed.poses)
      if (std::ranges::none_of(different, [&](const Pose& d) {
            return std::abs(std::log(d.pose.scale / pose.pose.scale)) < 0.03 &&
                   (d.pose.apply(centre) - pose.pose.apply(centre)).norm() <
                       0.02 * model.diagonal * pose.pose.scale &&
                   kernels::rotation_between(d.pose.rotation, pose.pose.rotation) < 0.06;
          }))
        different.push_back(pose);
    listed.poses = std::move(different);
  }

  void choose_poses() {
    for (Listed& listed : shortlist_)
      poses_.insert(poses_.end(), listed.poses.begin(), listed.poses.end());
    std::ranges::stable_sort(poses_, std::ranges::greater(), &Pose::coarse);
    poses_.resize(std::min(poses_.size(), kRefinedTogether));
    std::vector<std::uint8_t> wanted(shortlist_.size());
    for (const Pose& pose : poses_) wanted[pose.listed] = 1;
    for_each(shortlist_.size(), [&](std::size_t i) {
      if (wanted[i] != 0) shortlist_[i].tree.emplace(shortlist_[i].record.samples);
    });
  }

  void verify(Pose& pose) const {
    const RecognitionModel& model = shortlist_[pose.listed].record;
    pose.pose = kernels::refined(model.samples, model.diagonal, pose.pose, tree_,
                                 {.reach = {0.03, 0.015, 0.01, 0.008}});
    pose.support = shortlist_[pose.listed].votes.support(pose.pose, kSupport);
    measure(pose, {});
  }

  /// Against what of the scene is not used up yet.
  void measure(Pose& pose, std::span<const std::uint8_t> used) const {
    const Listed& listed = shortlist_[pose.listed];
    const RecognitionModel& model = listed.record;
    const kernels::OverlapOptions options = close(model, pose.pose);
    pose.overlap = kernels::overlap(model.samples, model.diagonal, pose.pose, tree_, options,
                                    kFineSamples, used);
    const auto marks = kernels::explained(*listed.tree, model.diagonal, pose.pose, scene_.samples,
                                          options, kExplainedSamples, used);
    pose.explained = static_cast<double>(std::ranges::count(marks, 1)) /
                     static_cast<double>(std::max<std::size_t>(marks.size(), 1));
    pose.score = score_of(pose);
  }

  /// Measured on thousands of right and wrong poses: most of all a right one is not contradicted
  /// and lies close; how much of model and scene match says less, as either may be a small part of
  /// the other. A pose that surfaces alone speak for is half as good as one that triplets want,
  /// too.
  static double score_of(const Pose& pose) {
    const kernels::Overlap& o = pose.overlap;
    if (o.match <= 0) return 0;
    const double whole = o.closeness * o.match / (o.match + o.conflict);
    return std::sqrt(o.match) * std::pow(whole, 4) * std::pow(pose.explained, 0.1) *
           (10 + pose.support) / (20 + pose.support);
  }

  Candidate candidate_of(const Pose& pose) const {
    const Listed& listed = shortlist_[pose.listed];
    Candidate candidate;
    candidate.model = listed.model;
    candidate.votes = matches_.votes[listed.model];
    candidate.cluster = pose.cluster;
    candidate.support = pose.support;
    candidate.closeness = pose.overlap.closeness;
    candidate.match = pose.overlap.match;
    candidate.conflict = pose.overlap.conflict;
    candidate.explained = pose.explained;
    candidate.score = pose.score;
    const Similarity from_file = {.translation = -listed.record.origin};
    const Similarity to_file = {.translation = scene_.origin};
    candidate.pose = to_file * pose.pose * from_file;
    return candidate;
  }

  void rank() {
    std::ranges::stable_sort(poses_, std::ranges::greater(), &Pose::score);
    std::vector<std::uint8_t> seen(shortlist_.size());
    for (const Pose& pose : poses_)
      if (std::exchange(seen[pose.listed], 1) == 0) result_.ranking.push_back(candidate_of(pose));
  }

  /// The best first; then the best on what it leaves unexplained, and so on.
  void find_objects() {
    std::vector<std::uint8_t> used(scene_.samples.points.size());
    std::vector<Pose> left = poses_;
    while (true) {
      std::erase_if(left, [this](const Pose& pose) { return pose.score < options_.min_score; });
      if (left.empty() || left.front().score <= 0) return;
      const Pose best = left.front();
      result_.objects.push_back(candidate_of(best));
      const Listed& listed = shortlist_[best.listed];
      // A little more than what matches: rims of what is explained are nobody else's.
      const auto marks = kernels::explained(*listed.tree, listed.record.diagonal, best.pose,
                                            scene_.samples, {.match = 0.02, .min_cosine = 0.3},
                                            static_cast<std::int64_t>(used.size()));
      for (std::size_t i = 0; i < marks.size(); ++i) used[i] |= marks[i];
      left.erase(left.begin());
      for_each(left.size(), [&](std::size_t i) { measure(left[i], used); });
      std::ranges::stable_sort(left, std::ranges::greater(), &Pose::score);
    }
  }

  const io::HashLibrary& library_;
  const RecognitionModel& scene_;
  const RecognitionOptions& options_;
  const engine::RunContext& context_;
  kernels::SampleTree tree_;
  TripletMatches matches_;
  std::vector<Listed> shortlist_;
  std::vector<Pose> poses_;
  Recognition result_;
};

}  // namespace

Recognition recognise_scene(const io::HashLibrary& library, const RecognitionModel& scene,
                            const RecognitionOptions& options, const engine::RunContext& context) {
  return Recogniser(library, scene, options, context).run();
}

}  // namespace semigeo::jobs
