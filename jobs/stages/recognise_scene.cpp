#include "jobs/stages/recognise_scene.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "jobs/stages/match_triplets.hpp"
#include "kernels/recognition/feature_pair.hpp"
#include "kernels/recognition/feature_triangle.hpp"
#include "kernels/recognition/overlap.hpp"
#include "kernels/recognition/pose_clusters.hpp"

namespace semigeo::jobs {
namespace {

using Eigen::Vector3d;
using kernels::RecognitionModel;
using kernels::Similarity;

/// A scene's feature may be a little out of the band that the model's is in.
constexpr double kBandSlack = 1.075;
/// Coarse scans and small pieces have few features: with fewer triplets pairs are looked for, too.
constexpr std::int64_t kFewTriplets = 10'000;
constexpr int kScenePairNeighbours = 16;
constexpr double kPairWeight = 0.5;  ///< of a pair's vote: chance has it agree more often

constexpr std::size_t kShortlist = 400;            ///< models with the best votes
constexpr std::size_t kMostMatches = 8000;         ///< of one model, the weightiest;
constexpr std::size_t kMatchesTogether = 600'000;  ///< if there are many models, fewer of each

// Each look at a pose costs more than the one before, and fewer poses are looked at.
constexpr std::int64_t kGlanceSamples = 40;
constexpr std::size_t kGlanced = 40;  ///< of one model, go on
constexpr std::size_t kFewModels = 40;
constexpr int kFewClusters = 24;             ///< of each of more models than that; and of these
constexpr std::size_t kModelsByGlance = 40;  ///< go on: those that look best,
constexpr std::size_t kModelsByWeight = 30;  ///< and those of the heaviest clusters besides
constexpr std::int64_t kCoarseSamples = 200;
constexpr std::size_t kCoarseByWeight = 3;  ///< besides, whatever they look like
constexpr std::int64_t kMiddleSamples = 400;
struct Effort {
  std::size_t coarse;    ///< poses of one model by overlap, are refined a little
  std::size_t refined;   ///< of one model
  std::size_t together;  ///< of all
};
constexpr Effort kUsual = {.coarse = 5, .refined = 4, .together = 60};
constexpr Effort kOfPairs = {
    .coarse = 8, .refined = 6, .together = 120};  // say little by themselves
constexpr std::int64_t kFineSamples = 2000;
constexpr std::int64_t kExplainedSamples = 4000;

constexpr kernels::OverlapOptions kCoarse = {.match = 0.02, .conflict = 0.06, .min_cosine = 0.6};
/// Noise and triangulation grow with the edges: of coarse scans the surfaces that are one lie
/// farther apart. In mean edge lengths of the coarser one, and at most so many diagonals.
constexpr double kMatchEdges = 0.5;
constexpr double kWidestMatch = 0.03;
constexpr double kHeld = 0.03;  ///< stability of which half is missing
/// Poses tried turned: loosely, as turns are tried in steps.
constexpr kernels::OverlapOptions kTurning = {.match = 0.03, .conflict = 0.06, .min_cosine = 0.6};
constexpr std::size_t kTurnedTogether = 6;
constexpr std::size_t kTurnedPerPose = 3;
constexpr double kTurnedShare = 0.7;  ///< of the agreement before, to go on

constexpr kernels::PoseTolerance kSupport = {.log_scale = 0.15, .distance = 0.06, .angle = 0.25};

/// What a scene must enter to find what a model has.
template <typename Options>
Options as_scene(Options options) {
  options.nearest /= kBandSlack;
  options.farthest *= kBandSlack;
  options.every_order = true;
  return options;
}

kernels::TripletOptions scene_triplets() {
  kernels::TripletOptions options = as_scene(kernels::TripletOptions{});
  options.min_height *= 0.9;
  return options;
}

kernels::PairOptions scene_pairs() {
  return as_scene(kernels::PairOptions{.neighbours = kScenePairNeighbours});
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
  kernels::PoseVotes votes;  ///< of triplets
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
    if (result_.scene_triplets < kFewTriplets)
      pairs_ = kernels::local_pairs(scene_.features, scene_pairs());
    shortlist();
    for_each(shortlist_.size(), [this](std::size_t i) { find_poses(i); });
    choose_models();
    for_each(shortlist_.size(), [this](std::size_t i) { look_closer(shortlist_[i]); });
    choose_poses();
    for_each(poses_.size(), [this](std::size_t i) { verify(poses_[i]); });
    try_turned();
    rank();
    find_objects();
    return std::move(result_);
  }

 private:
  const Effort& effort() const { return pairs_.empty() ? kUsual : kOfPairs; }

  template <typename Body>
  void for_each(std::size_t count, const Body& body) {
    context_.workers.for_blocks(static_cast<std::int64_t>(count), 1, [&](engine::IndexRange range) {
      for (auto i = range.begin; i < range.end; ++i) body(static_cast<std::size_t>(i));
    });
  }

  /// Models that got votes, those first that got the most beyond what chance gives a model with so
  /// many triplets, in standard deviations. Those without votes may have pairs.
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
    std::ranges::stable_sort(matches, {}, &TripletMatch::triangle);
    listed.votes = votes(
        matches, [](const TripletMatch& match) { return match.triangle; },
        [&](const TripletMatch& match) {
          return kernels::similarity_between(
              kernels::feature_triangle(model.features, match.model_corners),
              kernels::feature_triangle(scene_.features, match.scene_corners));
        },
        model);
    add_clusters(listed.votes, 1, index);
    if (!pairs_.empty() && index < kFewModels) {
      const std::vector<kernels::FeaturePair> pairs = kernels::local_pairs(model.features, {});
      const kernels::PoseVotes of_pairs = votes(
          kernels::match_pairs(pairs_, pairs), [](const kernels::PairMatch& m) { return m.scene; },
          [&](const kernels::PairMatch& m) {
            return kernels::similarity_between(pairs[m.model], pairs_[m.scene]);
          },
          model);
      add_clusters(of_pairs, kPairWeight, index);
    }
    look(listed, kGlanceSamples, coarse);
    keep(listed.poses, kGlanced, kCoarseByWeight);
  }

  /// The poses that matches, those of one part of the scene side by side, vote for. A match shares
  /// its part with others of this model only: what agrees on a pose must not depend on how many
  /// models the library has.
  template <typename Match, typename PartOf, typename PoseOf>
  static kernels::PoseVotes votes(const std::vector<Match>& matches, const PartOf& part_of,
                                  const PoseOf& pose_of, const RecognitionModel& model) {
    struct Weighed {
      double weight;
      std::size_t match;
    };
    std::vector<Weighed> weighed;
    weighed.reserve(matches.size());
    for (auto first = matches.begin(); first != matches.end();) {
      const auto last = std::find_if(first, matches.end(), [&](const Match& match) {
        return part_of(match) != part_of(*first);
      });
      const double weight = 1.0 / static_cast<double>(last - first);
      for (; first != last; ++first)
        weighed.push_back({weight, static_cast<std::size_t>(first - matches.begin())});
    }
    if (weighed.size() > kMostMatches) {
      std::ranges::stable_sort(weighed, std::ranges::greater(), &Weighed::weight);
      weighed.resize(kMostMatches);
      std::ranges::sort(weighed, {}, &Weighed::match);
    }
    std::vector<kernels::PoseVote> result;
    result.reserve(weighed.size());
    for (const auto& [weight, match] : weighed) result.push_back({pose_of(matches[match]), weight});
    return {result, model.centre.cast<double>(), model.diagonal};
  }

  void add_clusters(const kernels::PoseVotes& votes, double weight, std::size_t index) {
    kernels::ClusterOptions options;
    if (shortlist_.size() > kFewModels) options = {.seeds = 4 * kFewClusters, .most = kFewClusters};
    for (const kernels::PoseCluster& cluster : votes.clusters(options))
      shortlist_[index].poses.push_back(
          {.listed = index, .pose = cluster.pose, .cluster = weight * cluster.weight});
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
    keep(listed.poses, effort().coarse, kCoarseByWeight);
    for (Pose& pose : listed.poses) approach(pose);
    leave_out_repeated(listed);
    look(listed, kMiddleSamples, [&](const Pose& pose) { return close(model, pose.pose); });
    keep(listed.poses, effort().refined, 0);
  }

  /// From as far as clusters of votes may lie.
  void approach(Pose& pose) const {
    const RecognitionModel& model = shortlist_[pose.listed].record;
    pose.pose = kernels::refined(model.samples, model.diagonal, pose.pose, tree_,
                                 {.reach = {0.08, 0.05}, .iterations = 3, .count = 200});
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
    poses_.resize(std::min(poses_.size(), effort().together));
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

  /// A cup may have been found with its handle anywhere: the best poses are tried turned, as far as
  /// the model is nearly symmetric.
  void try_turned() {
    std::ranges::stable_sort(poses_, std::ranges::greater(), &Pose::score);
    std::vector<std::vector<Pose>> better(std::min(kTurnedTogether, poses_.size()));
    for_each(better.size(), [&](std::size_t i) { better[i] = better_turned(poses_[i]); });
    for (const std::vector<Pose>& of_pose : better)
      poses_.insert(poses_.end(), of_pose.begin(), of_pose.end());
  }

  std::vector<Pose> better_turned(const Pose& pose) const {
    const RecognitionModel& model = shortlist_[pose.listed].record;
    const auto glance = [&](const Similarity& similarity) {
      return kernels::overlap(model.samples, model.diagonal, similarity, tree_, kTurning,
                              kCoarseSamples)
          .agreement();
    };
    const double enough = kTurnedShare * glance(pose.pose);
    std::vector<Pose> tried;
    for (const Similarity& other : kernels::turned(model.samples, model.diagonal, pose.pose, tree_,
                                                   close(model, pose.pose), kFineSamples))
      if (const double coarse = glance(other); coarse > enough)
        tried.push_back(
            {.listed = pose.listed, .pose = other, .cluster = pose.cluster, .coarse = coarse});
    keep(tried, kTurnedPerPose, 0);
    for (Pose& other : tried) {
      approach(other);
      verify(other);
    }
    std::erase_if(tried, [&](const Pose& other) { return other.score <= pose.score; });
    return tried;
  }

  /// Against what of the scene is not used up yet.
  void measure(Pose& pose, std::span<const std::uint8_t> used) const {
    const Listed& listed = shortlist_[pose.listed];
    const RecognitionModel& model = listed.record;
    kernels::OverlapOptions options = close(model, pose.pose);
    options.stability = true;
    pose.overlap = kernels::overlap(model.samples, model.diagonal, pose.pose, tree_, options,
                                    kFineSamples, used);
    const auto marks = kernels::explained(*listed.tree, model.diagonal, pose.pose, scene_.samples,
                                          options, kExplainedSamples, used);
    pose.explained = static_cast<double>(std::ranges::count(marks, 1)) /
                     static_cast<double>(std::max<std::size_t>(marks.size(), 1));
    pose.score = score_of(pose);
  }

  /// Measured on thousands of right and wrong poses: most of all a right one lies close, is not
  /// contradicted, and is held fast by what matches; how much of model and scene match says less,
  /// as either may be a small part of the other, but not both. A pose that surfaces alone speak for
  /// is worth a little less than one that triplets want, too.
  static double score_of(const Pose& pose) {
    const kernels::Overlap& o = pose.overlap;
    if (o.match <= 0) return 0;
    const double unopposed = o.match / (o.match + o.conflict);
    const double either = o.match + pose.explained - o.match * pose.explained;
    const double wanted = (10 + pose.support) / (20 + pose.support);
    const double held = o.stability / (o.stability + kHeld);
    return std::sqrt(o.match * either) * std::pow(held, 0.75) * std::pow(unopposed, 1.5) *
           std::pow(o.closeness, 8) * std::pow(pose.explained * wanted, 0.25);
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
    candidate.stability = pose.overlap.stability;
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
  std::vector<kernels::FeaturePair> pairs_;  ///< of the scene, if it has few triplets
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
