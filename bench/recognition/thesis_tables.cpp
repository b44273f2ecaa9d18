#include "bench/recognition/thesis_tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "bench/recognition/experiments.hpp"
#include "bench/recognition/model_library.hpp"
#include "bench/support/chance.hpp"
#include "bench/support/mesh_changes.hpp"
#include "kernels/features/features.hpp"
#include "kernels/repair/surface_builder.hpp"

namespace semigeo::recognition {
namespace {

using jobs::ThesisScore;
using Json = nlohmann::json;

constexpr std::size_t kComposedScenes = 3;
constexpr SceneKind kComplete = {.name = "complete", .says = "", .vertices_left = 0.6};
constexpr SceneKind kPartial = {
    .name = "partial", .says = "", .vertices_left = 0.6, .removed = 0.6};

/// Returns a scene of one object, placed as in table 6.1.
Scene placed(const SceneKind& kind, const BenchModel& model, std::size_t index,
             const ThesisPlacement& placement, std::uint64_t seed) {
  Scene scene{.kind = kind.name,
              .name = model.name,
              .seed = seed,
              .mesh = changed(kind, model.mesh, bench::random(seed, 0, model.name)),
              .objects = {{.model = index, .pose = similarity_of(placement)}}};
  bench::move(scene.mesh, scene.objects.front().pose);
  return scene;
}

/// Recognises scenes with both methods.
class Looker {
 public:
  Looker(ModelSpan models, const io::HashLibrary& library,
         const jobs::RecognitionParameters& parameters,
         const jobs::ThesisRecognitionOptions& options, const engine::RunContext& context)
      : models_(models),
        library_(library),
        names_(model_names(library)),
        parameters_(parameters),
        context_(context),
        database_(library, options, context) {}

  const std::vector<std::string>& names() const { return names_; }

  void look(const Scene& scene, ThesisExperiment& experiment) const {
    const kernels::BuiltSurface built = kernels::build_surface(kernels::TriangleMesh(scene.mesh));
    const kernels::RecognitionModel model = jobs::recognition_model(built, parameters_, context_);
    experiment.scenes.push_back(scene.name);
    std::vector<std::string>& truth = experiment.truth.emplace_back();
    for (const PlacedObject& object : scene.objects) truth.push_back(models_[object.model]->name);
    experiment.scores.push_back(database_.scores(model));
    const jobs::Recognition found = jobs::recognise_scene(library_, model, {}, context_);
    experiment.recognised.push_back(found.ranking.empty() ? ""
                                                          : names_.at(found.ranking.front().model));
  }

 private:
  ModelSpan models_;
  const io::HashLibrary& library_;
  std::vector<std::string> names_;
  const jobs::RecognitionParameters& parameters_;
  const engine::RunContext& context_;
  jobs::ThesisDatabase database_;
};

void print_row_head(const std::string& text) {
  std::printf("%-16.16s", text.c_str());
}

/// Prints one number of every model in every scene. A number that is missing is a dash.
void print_matrix(const std::string& title, const std::vector<std::string>& models,
                  const ThesisExperiment& experiment,
                  const std::function<double(const ThesisScore&)>& value) {
  std::printf("\n%s\n", title.c_str());
  print_row_head("");
  for (const std::string& scene : experiment.scenes) std::printf(" %9.9s", scene.c_str());
  std::printf("\n");
  for (std::size_t i = 0; i < models.size(); ++i) {
    print_row_head(models[i]);
    for (std::size_t k = 0; k < experiment.scenes.size(); ++k) {
      const double number = value(experiment.scores[k][i]);
      const bool there = std::ranges::count(experiment.truth[k], models[i]) > 0;
      char text[32] = "-";
      if (std::isfinite(number))
        std::snprintf(text, sizeof text, "%.0f%s", number, there ? "*" : " ");
      std::printf(" %9s", text);
    }
    std::printf("\n");
  }
}

/// Returns the model with the largest value.
std::string best(const std::vector<std::string>& models, const std::vector<ThesisScore>& scores,
                 const std::function<double(const ThesisScore&)>& value) {
  const auto at = std::ranges::max_element(scores, {}, value);
  return at == scores.end() || !(value(*at) > 0) ? "" : models[at - scores.begin()];
}

double total(const ThesisScore& score) {
  return score.total;
}
double cluster(const ThesisScore& score) {
  return score.survives ? static_cast<double>(score.cluster) : std::nan("");
}
double cluster_or_none(const ThesisScore& score) {
  return score.survives ? static_cast<double>(score.cluster) : 0.0;
}

void print_named(const std::vector<std::string>& models, const ThesisExperiment& experiment) {
  int votes = 0, clusters = 0, own = 0;
  for (std::size_t k = 0; k < experiment.scenes.size(); ++k) {
    const auto there = [&](const std::string& name) {
      return std::ranges::count(experiment.truth[k], name) > 0 ? 1 : 0;
    };
    votes += there(best(models, experiment.scores[k], total));
    clusters += there(best(models, experiment.scores[k], cluster_or_none));
    own += there(experiment.recognised[k]);
  }
  std::printf(
      "\nOf %zu scenes an object of the scene is named first by votes in %d, by clusters in %d, by "
      "recognise_scene in %d.\n",
      experiment.scenes.size(), votes, clusters, own);
}

void print_experiment(const std::vector<std::string>& models, const ThesisExperiment& experiment,
                      const char* score_table, const char* cluster_table) {
  for (int kind = 0; kind < kernels::kFeatureKinds; ++kind)
    print_matrix(std::string(experiment.title) + ", score of " + kernels::kFeatureKindNames[kind],
                 models, experiment,
                 [kind](const ThesisScore& score) { return score.of_kind[kind]; });
  print_matrix(std::string(score_table) + ": " + experiment.title + ", score", models, experiment,
               total);
  print_matrix(std::string(cluster_table) + ": " + experiment.title + ", largest cluster", models,
               experiment, cluster);
  print_named(models, experiment);
}

Json experiment_json(const ThesisExperiment& experiment) {
  Json scenes = Json::array();
  for (std::size_t k = 0; k < experiment.scenes.size(); ++k) {
    Json scores = Json::array();
    for (const ThesisScore& score : experiment.scores[k])
      scores.push_back({{"of_kind", score.of_kind},
                        {"total", score.total},
                        {"survives", score.survives},
                        {"cluster", score.cluster}});
    scenes.push_back({{"scene", experiment.scenes[k]},
                      {"truth", experiment.truth[k]},
                      {"scores", scores},
                      {"recognise_scene", experiment.recognised[k]}});
  }
  return scenes;
}

}  // namespace

ThesisTables thesis_tables(ModelSpan models, const jobs::RecognitionParameters& parameters,
                           const jobs::ThesisRecognitionOptions& options, std::uint64_t seed,
                           const std::filesystem::path& folder, const engine::RunContext& context) {
  const ModelLibraries libraries(models, parameters, folder, context);
  const auto library = libraries.without({});
  const Looker looker(models, *library, parameters, options, context);
  ThesisTables tables{.models = looker.names(),
                      .placed = {},
                      .placements = {},
                      .complete = {},
                      .partial = {},
                      .composed = {}};
  tables.complete.title = "complete objects";
  tables.partial.title = "partial objects";
  tables.composed.title = "three objects";
  const auto placements = thesis_placements();
  for (std::size_t i = 0; i < models.size(); ++i) {
    tables.placed.push_back(models[i]->name);
    tables.placements.push_back(placements[i % placements.size()]);
    looker.look(placed(kComplete, *models[i], i, tables.placements[i], seed), tables.complete);
    looker.look(placed(kPartial, *models[i], i, tables.placements[i], seed), tables.partial);
  }
  const std::size_t count = models.size() < 3 ? 0 : kComposedScenes;
  for (std::size_t i = 0; i < count; ++i)
    looker.look(make_scene(*scene_kind("F60"), models, i * models.size() / count, seed),
                tables.composed);
  return tables;
}

void print(const ThesisTables& tables) {
  std::printf("Table 6.1: scale factors and rotation angles of the scenes\n%-16s %6s %6s %6s %6s\n",
              "", "scale", "x", "y", "z");
  for (std::size_t i = 0; i < tables.placements.size(); ++i) {
    const ThesisPlacement& p = tables.placements[i];
    print_row_head(tables.placed[i]);
    std::printf(" %6.1f %6.0f %6.0f %6.0f   (%s)\n", p.scale, p.x, p.y, p.z, p.object);
  }
  std::printf("\n* the model is in the scene\n");
  print_experiment(tables.models, tables.complete, "Table 6.2", "Table 6.3");
  print_experiment(tables.models, tables.partial, "Table 6.4", "Table 6.5");
  if (!tables.composed.scenes.empty())
    print_experiment(tables.models, tables.composed, "Table 6.6", "Table 6.6");
}

std::string json(const ThesisTables& tables) {
  const Json document = {{"models", tables.models},
                         {"complete", experiment_json(tables.complete)},
                         {"partial", experiment_json(tables.partial)},
                         {"composed", experiment_json(tables.composed)}};
  return document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace semigeo::recognition
