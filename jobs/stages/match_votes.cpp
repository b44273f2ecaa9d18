#include "jobs/stages/match_votes.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <tuple>

#include "kernels/recognition/feature_triangle.hpp"

namespace semigeo::jobs {
namespace {

using kernels::RecognitionModel;

/// Returns the options with which features of a scene are combined, to find what a model has.
template <typename Options>
Options as_scene(Options options, double band_slack) {
  options.nearest /= band_slack;
  options.farthest *= band_slack;
  options.every_order = true;
  return options;
}

/// Returns the poses that matches vote for. The matches of one part of the scene must lie side by
/// side. Of more than `most` matches the weightiest vote.
template <typename Match, typename PartOf, typename PoseOf>
kernels::PoseVotes votes_of(const std::vector<Match>& matches, const PartOf& part_of,
                            const PoseOf& pose_of, const RecognitionModel& model,
                            std::size_t most) {
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
  if (weighed.size() > most) {
    std::ranges::stable_sort(weighed, std::ranges::greater(), &Weighed::weight);
    weighed.resize(most);
    std::ranges::sort(weighed, {}, &Weighed::match);
  }
  std::vector<kernels::PoseVote> result;
  result.reserve(weighed.size());
  for (const auto& [weight, match] : weighed) result.push_back({pose_of(matches[match]), weight});
  return {result, model.centre.cast<double>(), model.diagonal};
}

}  // namespace

kernels::TripletOptions scene_triplet_options(const LookUpTuning& tuning) {
  kernels::TripletOptions options = as_scene(kernels::TripletOptions{}, tuning.band_slack);
  options.min_height *= tuning.height_slack;
  return options;
}

kernels::PairOptions scene_pair_options(const RecognitionTuning& tuning) {
  return as_scene(kernels::PairOptions{.neighbours = tuning.pairs.neighbours},
                  tuning.look_up.band_slack);
}

std::vector<TripletMatch> weightiest_matches(const TripletMatches& all, std::int64_t model,
                                             std::size_t most, const MatchFilter& filter) {
  std::vector<TripletMatch> matches(all.matches.begin() + all.first[model],
                                    all.matches.begin() + all.first[model + 1]);
  if (filter) std::erase_if(matches, [&](const TripletMatch& match) { return !filter(match); });
  if (matches.size() > most) {
    const auto heavier = [](const TripletMatch& a, const TripletMatch& b) {
      return std::tie(b.weight, a.triangle, a.model_corners) <
             std::tie(a.weight, b.triangle, b.model_corners);
    };
    std::ranges::nth_element(matches, matches.begin() + static_cast<std::ptrdiff_t>(most), heavier);
    matches.resize(most);
    std::ranges::sort(matches, heavier);
  }
  std::ranges::stable_sort(matches, {}, &TripletMatch::triangle);
  return matches;
}

kernels::Similarity pose_of(const TripletMatch& match, const RecognitionModel& model,
                            const kernels::OrientedFeatures& scene) {
  return kernels::similarity_between(kernels::feature_triangle(model.features, match.model_corners),
                                     kernels::feature_triangle(scene, match.scene_corners));
}

double scale_of(const TripletMatch& match, const RecognitionModel& model,
                const kernels::OrientedFeatures& scene) {
  const auto perimeter = [](const kernels::OrientedTriangle& t) {
    return (t.points[0] - t.points[1]).norm() + (t.points[1] - t.points[2]).norm() +
           (t.points[2] - t.points[0]).norm();
  };
  return perimeter(kernels::feature_triangle(scene, match.scene_corners)) /
         perimeter(kernels::feature_triangle(model.features, match.model_corners));
}

kernels::PoseVotes votes_of_triplets(const std::vector<TripletMatch>& matches,
                                     const RecognitionModel& model,
                                     const kernels::OrientedFeatures& scene) {
  return votes_of(
      matches, [](const TripletMatch& match) { return match.triangle; },
      [&](const TripletMatch& match) { return pose_of(match, model, scene); }, model,
      std::numeric_limits<std::size_t>::max());
}

kernels::PoseVotes votes_of_pairs(std::span<const kernels::FeaturePair> of_scene,
                                  const RecognitionModel& model, std::size_t most,
                                  const ScaleRange& scale) {
  const std::vector<kernels::FeaturePair> pairs = kernels::local_pairs(model.features, {});
  std::vector<kernels::PairMatch> matches = kernels::match_pairs(of_scene, pairs);
  if (!scale.is_any())
    std::erase_if(matches, [&](const kernels::PairMatch& m) {
      return !scale.has(kernels::similarity_between(pairs[m.model], of_scene[m.scene]).scale);
    });
  return votes_of(
      matches, [](const kernels::PairMatch& m) { return m.scene; },
      [&](const kernels::PairMatch& m) {
        return kernels::similarity_between(pairs[m.model], of_scene[m.scene]);
      },
      model, most);
}

}  // namespace semigeo::jobs
