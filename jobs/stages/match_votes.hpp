#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "jobs/stages/match_triplets.hpp"
#include "jobs/stages/recognise_scene.hpp"
#include "jobs/stages/recognition_tuning.hpp"
#include "kernels/recognition/feature_pair.hpp"
#include "kernels/recognition/pose_clusters.hpp"
#include "kernels/recognition/recognition_model.hpp"
#include "kernels/recognition/similarity.hpp"
#include "kernels/recognition/triplet.hpp"

namespace semigeo::jobs {

/// Returns the options with which triplets of a scene are made, so that what a model has is among
/// them.
kernels::TripletOptions scene_triplet_options(const LookUpTuning& tuning);

/// Returns the options with which pairs of features of a scene are made.
kernels::PairOptions scene_pair_options(const RecognitionTuning& tuning);

// A match shares its part of the scene, a triangle or a pair, with others of the same model only:
// what agrees on a pose must not depend on how many models the library has.

/// Tells whether a match is used.
using MatchFilter = std::function<bool(const TripletMatch& match)>;

/// Returns the weightiest matches of a model, at most `most`, those of one triangle side by side.
/// `model` is an index in HashLibrary::models. Matches that `filter` refuses are left out; it may
/// be empty.
std::vector<TripletMatch> weightiest_matches(const TripletMatches& matches, std::int64_t model,
                                             std::size_t most, const MatchFilter& filter = {});

/// Returns the pose of a model in which the two triplets of a match lie on each other.
kernels::Similarity pose_of(const TripletMatch& match, const kernels::RecognitionModel& model,
                            const kernels::OrientedFeatures& scene);

/// Returns the scale of that pose.
double scale_of(const TripletMatch& match, const kernels::RecognitionModel& model,
                const kernels::OrientedFeatures& scene);

/// Returns the poses of a model that matches of its triplets vote for. Those of one triangle must
/// lie side by side.
kernels::PoseVotes votes_of_triplets(const std::vector<TripletMatch>& matches,
                                     const kernels::RecognitionModel& model,
                                     const kernels::OrientedFeatures& scene);

/// Returns the poses of a model that matches of its pairs of features with those of the scene vote
/// for, if their scale is in the range. Of more than `most` matches the weightiest vote.
kernels::PoseVotes votes_of_pairs(std::span<const kernels::FeaturePair> of_scene,
                                  const kernels::RecognitionModel& model, std::size_t most,
                                  const ScaleRange& scale);

}  // namespace semigeo::jobs
