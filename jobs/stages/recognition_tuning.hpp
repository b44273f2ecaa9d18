#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/recognition/curvature_frame.hpp"
#include "kernels/recognition/overlap.hpp"
#include "kernels/recognition/pose_clusters.hpp"

namespace semigeo::jobs {

// The numbers with which models are found in a scene, step by step. They were chosen with the
// experiments of bench/RECOGNITION.md. Each look at a pose costs more than the one before, and
// fewer poses are looked at.

/// Step 1: triplets of the scene are looked up in the library. A scene with more triangles or
/// matches than are allowed is represented by an even share of its triangles: an object that is
/// seen well has hundreds of them.
struct LookUpTuning {
  /// A side of a scene's triplet may be longer or shorter than those of models by this factor.
  double band_slack = 1.075;
  /// The height of a scene's triplet may be smaller than those of models by this factor.
  double height_slack = 0.9;
  std::int64_t most_triangles = 32'000;        ///< Largest number of triangles looked up.
  std::int64_t most_compared = 3'000'000'000;  ///< Largest number of pairs of triplets compared.
  std::int64_t most_matches = 8'000'000;       ///< Largest number of matches, as estimated.
  /// With more pairs of triplets than this, the number of matches is estimated in a few blocks.
  double many_compared = 2e8;
  std::size_t probed_blocks = 12;    ///< Number of blocks of the library for the estimate.
  std::size_t probed_segments = 40;  ///< Number of cells of each block for the estimate.
};

/// Step 2: models with the best votes are listed.
struct ShortlistTuning {
  std::size_t most_models = 400;    ///< Largest number of listed models.
  std::size_t most_matches = 8000;  ///< Largest number of matches of one model, the weightiest.
  /// Largest number of matches of all listed models together.
  std::size_t most_matches_together = 600'000;
};

/// Pairs of features are matched as well if there are few triplets, as on coarse scans and small
/// pieces.
struct PairTuning {
  std::int64_t few_triplets = 10'000;  ///< Pairs are matched in scenes with fewer triplets.
  std::size_t most_models = 40;        ///< Number of models, first of the list, that get pairs.
  int neighbours = 16;                 ///< Number of nearest features that each one is paired with.
  double vote_weight = 0.5;  ///< Weight of a pair's vote: pairs agree by chance more often.
};

/// Step 3: matches that agree on a pose form clusters.
struct ClusterTuning {
  std::size_t few_models = 40;  ///< Longer lists of models get the two limits that follow.
  int most_of_many = 24;        ///< Largest number of clusters of a model on a long list.
  int seeds_of_many = 96;       ///< Largest number of poses tried as centres on a long list.
  /// Number of poses tried as centres in a scene that was seen from one place, where few votes of
  /// many are right.
  int seeds_of_view = 3000;
  /// A vote supports a pose from which it differs by less than this.
  kernels::PoseTolerance support = {.log_scale = 0.15, .distance = 0.06, .angle = 0.25};
};

/// Step 4: the pose of each cluster is compared with the scene at a glance.
struct GlanceTuning {
  std::int64_t samples = 40;           ///< Number of samples of the model that are compared.
  std::size_t poses_by_overlap = 40;   ///< Number of poses of a model that go on by agreement.
  std::size_t poses_by_weight = 3;     ///< Number of poses that go on by the weight of clusters.
  std::size_t models_by_overlap = 40;  ///< Number of models that go on by agreement.
  std::size_t models_by_weight = 30;   ///< Number of models that go on by the weight of clusters.
};

/// The number of poses that are refined.
struct RefinementEffort {
  std::size_t coarse;    ///< Number of poses of one model that are refined roughly.
  std::size_t refined;   ///< Number of poses of one model that are refined.
  std::size_t together;  ///< Number of poses of all models that are refined.
};

/// Step 5: poses are refined until the model lies on the scene's surface.
struct RefinementTuning {
  /// The effort if triplets alone were matched.
  RefinementEffort usual = {.coarse = 5, .refined = 4, .together = 60};
  /// The effort if pairs were matched, which say little by themselves.
  RefinementEffort of_pairs = {.coarse = 8, .refined = 6, .together = 120};
  /// The effort in a scene that was seen from one place, where a right pose of an object that is
  /// mostly hidden agrees with little of the scene before it is refined.
  RefinementEffort of_view = {.coarse = 16, .refined = 6, .together = 80};
  std::int64_t coarse_samples = 200;  ///< Number of samples compared before rough refinement.
  std::int64_t middle_samples = 400;  ///< Number of samples compared after rough refinement.
  std::size_t poses_by_weight = 3;    ///< Number of poses added by the weight of clusters.
  /// The tolerance before the rough refinement.
  kernels::OverlapOptions coarse_overlap = {.match = 0.02, .conflict = 0.06, .min_cosine = 0.6};
  /// The rough refinement reaches as far as clusters of votes may lie from the surface.
  kernels::RefineOptions rough = {.reach = {0.08, 0.05}, .iterations = 3, .count = 200};
  /// The fine refinement ends within the tolerance of a match.
  kernels::RefineOptions fine = {.reach = {0.03, 0.015, 0.01, 0.008}};
  /// Poses that differ by less than this after the rough refinement are one.
  kernels::PoseTolerance same = {.log_scale = 0.03, .distance = 0.02, .angle = 0.06};
};

/// The number of samples by which a pose is measured.
struct MeasuredSamples {
  std::int64_t of_model;  ///< Number of samples of the model that are compared.
  std::int64_t of_scene;  ///< Number of samples of the scene that are compared.
};

/// Step 6: refined poses are measured, and get their score. Noise and triangulation grow with the
/// edges: matching surfaces of coarse scans lie farther apart.
struct MeasurementTuning {
  MeasuredSamples samples = {.of_model = 2000, .of_scene = 4000};  ///< How many are compared.
  double match_edges = 0.5;    ///< Tolerance in mean edge lengths of the coarser surface.
  double widest_match = 0.03;  ///< Largest tolerance, in diagonals of the model.
};

/// Step 7: symmetric poses of the best poses are tried. A cup may have been found with its handle
/// anywhere.
struct SymmetricPoseTuning {
  std::size_t tried = 8;     ///< Number of best poses whose symmetric poses are tried.
  std::size_t per_pose = 6;  ///< Number of symmetric poses of one pose that are refined.
  /// Of poses of a model at one place, however turned, only the best one is tried.
  kernels::PoseTolerance one_place = {.log_scale = 0.2, .distance = 0.2, .angle = 4};
  std::int64_t samples = 200;  ///< Number of samples of the model that are compared.
  /// The tolerance is loose, as turns are tried in steps.
  kernels::OverlapOptions overlap = {.match = 0.03, .conflict = 0.06, .min_cosine = 0.6};
  double enough = 0.7;  ///< Least share of the agreement of the first pose, to go on.
};

/// Step 7, in a scene that was seen from one place: models of the best poses grow and shrink along
/// the surface that matches them, until they have the best score. Three faces of a box tell its
/// size by their rims alone, which refinement does not see.
struct ScaledPoseTuning {
  std::size_t tried = 8;      ///< Number of best poses that are tried.
  double least_score = 0.05;  ///< A pose with a lower score is not tried.
  double most_held = 0.03;    ///< See Slippage::free_scaling.
  MeasuredSamples samples = {.of_model = 600, .of_scene = 1200};  ///< How many are compared.
  /// Logarithms of the scales that are tried, with either sign.
  std::vector<double> ways = {0.05, 0.1, 0.15, 0.2, 0.3, 0.4};
  /// Then smaller ways from the best one.
  std::vector<double> finer = {0.025, 0.0125, 0.006};
  double gain = 1.05;  ///< The least ratio of the new score to the old one.
};

/// Step 8: the best pose is an object; the others are measured against the rest of the scene.
struct ObjectTuning {
  /// Samples of the scene that lie on an object by this tolerance belong to no other. It is wider
  /// than that of a match, so that rims of an object support no other one.
  kernels::OverlapOptions used = {.match = 0.02, .min_cosine = 0.3};
};

/// Step 9: what the objects leave of a scene that was seen from one place is looked at once more.
/// An object that is mostly hidden has few triangles, so more of them are looked up.
struct SecondLookTuning {
  double least_left = 0.05;               ///< Least share of the scene that must be left.
  std::int64_t most_triangles = 200'000;  ///< Largest number of triangles looked up.
  std::size_t most_matches = 20'000;      ///< Largest number of matches of one model.
};

/// Step 10: the curvature of what is still left of such a scene votes for poses of the models that
/// were not found. It needs no features.
struct ThirdLookTuning {
  /// Number of models that are tried, those with the fewest features first.
  std::size_t most_models = 40;
  /// Which points of the scene vote. Samples of the scene lie closer together than those of models.
  kernels::FrameOptions of_scene = {.radius = 5, .most = 300};
  kernels::FrameOptions of_model = {.radius = 3, .most = 300};  ///< Which points of a model vote.
  double ratio_tolerance = 0.06;  ///< Largest difference of the ratios of curvatures that match.
  kernels::ClusterOptions clusters = {.seeds = 600, .most = 60};  ///< How votes form clusters.
  double vote_weight = 0.1;  ///< Weight of a vote: points agree by chance far more often.
};

/// The weights of the score, measured on thousands of right and wrong poses. The score is
///   sqrt(match either) held^h unopposed^u closeness^c (explained wanted)^e
/// where either = 1 - (1 - match) (1 - explained), held = hold / (hold + half) with
/// hold = stability + s support, unopposed = match / (match + conflict), and
/// wanted = (prior + support) / (2 prior + support).
struct ScoreWeights {
  /// The exponent of closeness. A right pose most of all lies close to the surface.
  double closeness = 10;
  /// The exponent of `unopposed`. A right pose is not contradicted.
  double unopposed = 1.5;
  /// The exponent of `held`. A right pose is held fast by what matches.
  double held = 0.75;
  /// The hold of which `held` is one half.
  double half_held = 0.05;
  /// What a triplet adds to the hold: features hold a model where its surface can slip.
  double hold_of_support = 4e-4;
  /// The exponent of `explained` and `wanted`. The share of the scene that is explained says less,
  /// as a model may be a small part of the scene, or the scene a small part of the model.
  double explained = 0.25;
  /// The support with which a pose counts before any triplet wants it. A pose that surfaces alone
  /// speak for is worth a little less than one that triplets want as well.
  double prior_support = 10;
};

/// The score in a scene that was seen from one place is
///   match / visible there / visible sqrt(min(match / enough, 1)) held^h unopposed^u closeness^c
///   (min(explained / enough, 1) wanted)^e (match / (match + conflict))^a
///   (there / (there + behind))^b
/// where visible is the share of the model that should have been seen, and unopposed counts only
/// what was seen. It is multiplied by `weight`, so that one least score holds for both, and the
/// larger one of both scores counts.
struct ViewTuning {
  double enough_match = 0.2;      ///< A pose that matches less of the model has a lower score.
  double enough_explained = 0.1;  ///< A pose that explains less of the scene has a lower score.
  /// The exponent b. A right pose hides nothing that was seen behind it. That nothing was seen
  /// where a model lies says less: scanners miss what is dark or shiny.
  double hides_nothing = 3;
  /// The exponents h, u, c and e. What is seen of a right pose is seen nearly without a fault.
  ScoreWeights score = {.closeness = 11,
                        .unopposed = 3,
                        .held = 0.75,
                        .half_held = 0.015,
                        .explained = 0.5,
                        .prior_support = 4};
  /// The exponent a. Surfaces that were not seen hardly ever contradict a right pose; those of a
  /// box that lies on a flat part of something else do.
  double uncontradicted = 6;
  double weight = 0.6;  ///< Scores are multiplied by this.
};

/// All numbers of recognition. The defaults are what `semigeo recognise` uses.
struct RecognitionTuning {
  LookUpTuning look_up = {};
  ShortlistTuning shortlist = {};
  PairTuning pairs = {};
  ClusterTuning clusters = {};
  GlanceTuning glances = {};
  RefinementTuning refinement = {};
  MeasurementTuning measurement = {};
  SymmetricPoseTuning symmetric_poses = {};
  ScaledPoseTuning scaled_poses = {};
  ObjectTuning objects = {};
  SecondLookTuning second_look = {};
  ThirdLookTuning third_look = {};
  ScoreWeights score = {};
  ViewTuning view = {};
};

}  // namespace semigeo::jobs
