#include "bench/recognition/diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "jobs/stages/match_votes.hpp"
#include "kernels/recognition/pose_clusters.hpp"

namespace semigeo::recognition {
namespace {

using kernels::RecognitionModel;
using kernels::Similarity;

constexpr std::int64_t kFewFeatures = 12;
constexpr std::int64_t kFewMatches = 4;
constexpr double kFewVotes = 4;

/// Counts the features of a model at whose place in the scene there is one of the same kind, with a
/// like normal and scale.
std::int64_t shared_features(const RecognitionModel& model, const RecognitionModel& scene,
                             const Similarity& pose) {
  constexpr double kMinCosine = 0.8;
  constexpr double kMaxLogScale = 0.35;
  return std::ranges::count_if(model.features.features, [&](const kernels::OrientedFeature& m) {
    const double sigma = pose.scale * model.features.level_scale[m.level];
    const Eigen::Vector3d place = pose.apply(m.position.cast<double>());
    const Eigen::Vector3d normal = pose.rotation * m.normal.cast<double>();
    return std::ranges::any_of(scene.features.features, [&](const kernels::OrientedFeature& s) {
      return s.code == m.code && (s.position.cast<double>() - place).norm() < sigma &&
             s.normal.cast<double>().dot(normal) > kMinCosine &&
             std::abs(std::log(scene.features.level_scale[s.level] / sigma)) < kMaxLogScale;
    });
  });
}

bool agree(const RecognitionModel& model, const Similarity& a, const Similarity& b) {
  return jobs::PoseExaminer::agree(model, a, b, {});
}

}  // namespace

std::string Diagnosis::lost(double min_score) const {
  if (features < kFewFeatures) return "features";
  if (matches < kFewMatches) return "triplets";
  if (cluster == 0) return votes < kFewVotes ? "votes" : "clusters";
  return score < min_score ? "score" : "looks";
}

Diagnoser::Diagnoser(const io::HashLibrary& library, const RecognitionModel& scene,
                     const jobs::RecognitionOptions& options, const engine::RunContext& context)
    : library_(library),
      scene_(scene),
      options_(options),
      examiner_(scene, options.tuning),
      matches_(jobs::match_triplets(
          library,
          kernels::local_triplets(scene.features,
                                  jobs::scene_triplet_options(options.tuning.look_up)),
          options.tuning.look_up, context)) {}

Diagnosis Diagnoser::diagnosis(std::int64_t index, const Similarity& truth) const {
  const jobs::RecognitionTuning& tuning = options_.tuning;
  jobs::ListedModel listed;
  listed.model = index;
  listed.record = library_.read_model(index);
  const RecognitionModel& model = listed.record;
  const Similarity pose =
      Similarity{.translation = -scene_.origin} * truth * Similarity{.translation = model.origin};
  Diagnosis result;
  result.features = shared_features(model, scene_, pose);
  const auto all =
      jobs::weightiest_matches(matches_, index, std::numeric_limits<std::size_t>::max());
  for (const jobs::TripletMatch& match : all)
    result.matches += agree(model, jobs::pose_of(match, model, scene_.features), pose) ? 1 : 0;
  listed.votes = jobs::votes_of_triplets(
      jobs::weightiest_matches(matches_, index, tuning.shortlist.most_matches), model,
      scene_.features);
  result.votes = listed.votes.support(pose, {});
  for (const kernels::PoseCluster& cluster :
       listed.votes.clusters({.seeds = tuning.clusters.seeds_of_view}))
    if (agree(model, cluster.pose, pose)) result.cluster = std::max(result.cluster, cluster.weight);
  listed.tree.emplace(model.samples);
  jobs::ExaminedPose examined;
  examined.pose = pose;
  examiner_.verify(listed, examined);
  result.score = examined.score;
  return result;
}

}  // namespace semigeo::recognition
