#include "jobs/stages/thesis_recognition.hpp"

#include <algorithm>
#include <utility>

#include "kernels/features/features.hpp"
#include "kernels/recognition/feature_triangle.hpp"
#include "kernels/recognition/thesis/grown_clusters.hpp"

namespace semigeo::jobs {
namespace {

using kernels::FeatureKind;
using kernels::kFeatureKinds;
using kernels::RecognitionModel;
using kernels::ThesisTriplet;

/// Number of triplets of the scene that are looked up together.
constexpr std::int64_t kBlock = 256;
/// The largest number of poses of a model that are clustered. If there are more, they are thinned
/// out evenly.
constexpr std::size_t kMostPoses = 20000;

}  // namespace

/// A triplet of a model and the triplet of the scene that agrees with it.
struct ThesisDatabase::Match {
  std::uint32_t model = 0;
  std::array<std::uint16_t, 3> model_corners = {};
  std::array<std::uint16_t, 3> scene_corners = {};
};

ThesisDatabase::ThesisDatabase(const io::HashLibrary& library,
                               const ThesisRecognitionOptions& options,
                               const engine::RunContext& context)
    : options_(options),
      context_(context),
      models_(library.models().size()),
      counts_(models_.size()) {
  std::array<std::vector<std::vector<ThesisTriplet>>, kFeatureKinds> triplets;
  for (auto& of_models : triplets) of_models.resize(models_.size());
  context.workers.for_blocks(std::ssize(models_), 1, [&](engine::IndexRange range) {
    for (auto i = range.begin; i < range.end; ++i) {
      models_[i] = library.read_model(i);
      models_[i].samples = {};
      for (int kind = 0; kind < kFeatureKinds; ++kind) {
        const auto chosen =
            kernels::strongest_features(models_[i].features, static_cast<FeatureKind>(kind),
                                        options_.level, options_.hash.strongest);
        counts_[i][kind] = std::ssize(chosen);
        triplets[kind][i] =
            kernels::thesis_triplets(models_[i].features, chosen, options_.hash, false);
      }
    }
  });
  for (const auto& of_models : triplets) {
    std::vector<kernels::ThesisTable::Entry> entries;
    for (std::size_t i = 0; i < models_.size(); ++i)
      for (const ThesisTriplet& triplet : of_models[i])
        entries.push_back({triplet, static_cast<std::uint32_t>(i)});
    tables_.emplace_back(std::move(entries), options_.hash);
  }
}

std::vector<ThesisDatabase::Match> ThesisDatabase::matches_of(const RecognitionModel& scene,
                                                              int kind) const {
  const auto chosen = kernels::strongest_features(scene.features, static_cast<FeatureKind>(kind),
                                                  options_.level, options_.hash.strongest);
  const auto triplets = kernels::thesis_triplets(scene.features, chosen, options_.hash, true);
  const std::int64_t count = std::ssize(triplets);
  std::vector<std::vector<Match>> of_block((count + kBlock - 1) / kBlock);
  context_.workers.for_blocks(count, kBlock, [&](engine::IndexRange range) {
    std::vector<Match>& found = of_block[range.begin / kBlock];
    for (auto i = range.begin; i < range.end; ++i)
      tables_[kind].for_matches(triplets[i], [&](const kernels::ThesisTable::Entry& entry) {
        found.push_back({entry.model, entry.triplet.corners, triplets[i].corners});
      });
  });
  std::vector<Match> all;
  for (const auto& found : of_block) all.insert(all.end(), found.begin(), found.end());
  return all;
}

std::vector<ThesisScore> ThesisDatabase::scores(const RecognitionModel& scene) const {
  std::vector<ThesisScore> result(models_.size());
  std::vector<std::vector<Match>> of_model(models_.size());
  for (int kind = 0; kind < kFeatureKinds; ++kind) {
    std::vector<std::int64_t> votes(models_.size());
    for (const Match& match : matches_of(scene, kind)) {
      ++votes[match.model];
      of_model[match.model].push_back(match);
    }
    for (std::size_t i = 0; i < models_.size(); ++i) {
      result[i].of_kind[kind] = kernels::thesis_score(votes[i], counts_[i][kind]);
      result[i].total += result[i].of_kind[kind] / kFeatureKinds;
    }
  }
  double best = 0;
  for (const ThesisScore& score : result) best = std::max(best, score.total);
  context_.workers.for_blocks(std::ssize(models_), 1, [&](engine::IndexRange range) {
    for (auto i = range.begin; i < range.end; ++i) {
      result[i].matches = std::ssize(of_model[i]);
      result[i].survives = result[i].total > 0 && result[i].total >= options_.survivors * best;
      if (result[i].survives) verify(i, scene, of_model[i], result[i]);
    }
  });
  return result;
}

/// Source: thesis 4.6, 5.10. Differs: normals help to find the rotation
/// (kernels/recognition/similarity.hpp).
void ThesisDatabase::verify(std::size_t index, const RecognitionModel& scene,
                            const std::vector<Match>& matches, ThesisScore& score) const {
  const RecognitionModel& model = models_[index];
  const std::size_t step = (matches.size() + kMostPoses - 1) / kMostPoses;
  std::vector<kernels::Similarity> poses;
  for (std::size_t i = 0; i < matches.size(); i += step)
    poses.push_back(kernels::similarity_between(
        kernels::feature_triangle(model.features, matches[i].model_corners),
        kernels::feature_triangle(scene.features, matches[i].scene_corners)));
  const kernels::GrownCluster largest = kernels::largest_grown_cluster(
      poses, model.centre.cast<double>(), model.diagonal, options_.clusters);
  score.cluster = largest.members * static_cast<std::int64_t>(step);
  score.pose = kernels::Similarity{.translation = scene.origin} * largest.pose *
               kernels::Similarity{.translation = -model.origin};
}

Recognition ranked(const std::vector<ThesisScore>& scores, const RecognitionOptions& options) {
  Recognition result;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    result.matches += scores[i].matches;
    if (scores[i].total <= 0) continue;
    Candidate candidate;
    candidate.model = static_cast<std::int64_t>(i);
    candidate.votes = scores[i].total;
    candidate.score = candidate.cluster = static_cast<double>(scores[i].cluster);
    candidate.pose = scores[i].pose;
    result.ranking.push_back(candidate);
  }
  std::ranges::stable_sort(result.ranking, [](const Candidate& a, const Candidate& b) {
    return std::pair(a.score, a.votes) > std::pair(b.score, b.votes);
  });
  if (!result.ranking.empty() && result.ranking.front().score > 0 &&
      result.ranking.front().score >= options.min_score)
    result.objects.push_back(result.ranking.front());
  return result;
}

Recognition thesis_recognition(const io::HashLibrary& library, const RecognitionModel& scene,
                               const RecognitionOptions& options,
                               const engine::RunContext& context) {
  return ranked(ThesisDatabase(library, {}, context).scores(scene), options);
}

}  // namespace semigeo::jobs
