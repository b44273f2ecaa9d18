#include "bench/recognition/trial.hpp"

#include <algorithm>
#include <set>

#include "engine/observer.hpp"
#include "engine/stopwatch.hpp"
#include "kernels/recognition/single_view.hpp"
#include "kernels/repair/surface_builder.hpp"

namespace semigeo::recognition {
namespace {

/// Calls `body`, measures its time and returns its result.
template <typename Body>
auto timed(Seconds& seconds, const Body& body) {
  class Clock : public engine::Observer {
   public:
    explicit Clock(Seconds& seconds) : seconds_(seconds) {}
    void timed(std::string_view, double wall, double cpu) override { seconds_ = {wall, cpu}; }

   private:
    Seconds& seconds_;
  } clock(seconds);
  const engine::Stopwatch stopwatch(clock, "call");
  return body();
}

/// Returns the different models of a scene.
std::set<std::string> models_of(const std::vector<ObjectOutcome>& objects) {
  std::set<std::string> result;
  for (const ObjectOutcome& object : objects) result.insert(object.model);
  return result;
}

}  // namespace

bool Outcome::named() const {
  const int different = static_cast<int>(models_of(objects).size());
  return different > 0 && std::ranges::all_of(objects, [&](const ObjectOutcome& object) {
           return object.rank >= 1 && object.rank <= different;
         });
}

bool Outcome::posed() const {
  if (!named()) return false;
  return std::ranges::all_of(models_of(objects), [&](const std::string& model) {
    return std::ranges::any_of(objects, [&](const ObjectOutcome& object) {
      return object.model == model && right(object.ranked);
    });
  });
}

bool Outcome::reported() const {
  return !objects.empty() && std::ranges::all_of(objects, &ObjectOutcome::reported);
}

Outcome judged(const Scene& scene, ModelSpan models, const std::vector<std::string>& names,
               const jobs::Recognition& found) {
  Outcome outcome;
  outcome.kind = scene.kind;
  outcome.scene = scene.name;
  outcome.seed = scene.seed;
  outcome.scene_triplets = found.scene_triplets;
  outcome.matches = found.matches;
  outcome.noise = scene.noise;
  outcome.mixed_pixels = scene.mixed_pixels;
  for (const PlacedObject& object : scene.objects) {
    ObjectOutcome& placed = outcome.objects.emplace_back();
    placed.model = models[object.model]->name;
    placed.occlusion = object.occlusion;
    placed.clutter = object.clutter;
  }
  for (std::size_t i = 0; i < found.ranking.size(); ++i) {
    const jobs::Candidate& candidate = found.ranking[i];
    const std::string& name = names.at(candidate.model);
    if (i == 0) outcome.first = name;
    RankedModel& ranked = outcome.ranking.emplace_back();
    ranked.model = name;
    ranked.candidate = candidate;
    bool there = false;
    for (std::size_t k = 0; k < scene.objects.size(); ++k) {
      ObjectOutcome& object = outcome.objects[k];
      if (object.model != name) continue;
      there = true;
      const PoseError error =
          pose_error(*models[scene.objects[k].model], candidate.pose, scene.objects[k].pose);
      ranked.right = ranked.right || right(error);
      if (object.rank > 0) continue;
      object.rank = static_cast<int>(i) + 1;
      object.score = candidate.score;
      object.ranked = error;
    }
    if (!there && outcome.best_wrong.empty()) {
      outcome.best_wrong = name;
      outcome.best_wrong_score = candidate.score;
    }
  }
  for (const jobs::Candidate& candidate : found.objects) {
    bool there = false;
    for (std::size_t k = 0; k < scene.objects.size() && !there; ++k) {
      ObjectOutcome& object = outcome.objects[k];
      there =
          !object.reported && object.model == names.at(candidate.model) &&
          right(pose_error(*models[scene.objects[k].model], candidate.pose, scene.objects[k].pose));
      if (there) object.reported = true;
    }
    if (there) continue;
    if (outcome.false_objects++ == 0 || candidate.score > outcome.false_score) {
      outcome.false_best = names.at(candidate.model);
      outcome.false_score = candidate.score;
    }
  }
  return outcome;
}

Outcome try_scene(const Scene& scene, ModelSpan models, const std::vector<std::string>& names,
                  const Recogniser& recogniser, const Inspector& inspect,
                  const jobs::RecognitionParameters& parameters,
                  const engine::RunContext& context) {
  const kernels::BuiltSurface built = kernels::build_surface(kernels::TriangleMesh(scene.mesh));
  Seconds scale_space, search;
  kernels::RecognitionModel model = timed(scale_space, [&] {
    return jobs::recognition_model(built, jobs::scene_parameters(parameters), context);
  });
  model.eye = kernels::eye_of_view(model);
  const jobs::Recognition found = timed(search, [&] { return recogniser(model); });
  Outcome outcome = judged(scene, models, names, found);
  outcome.vertices = built.surface.vertex_count();
  outcome.features = std::ssize(model.features.features);
  outcome.scale_space = scale_space;
  outcome.search = search;
  outcome.single_view = model.eye.has_value();
  if (inspect) inspect(model, outcome);
  return outcome;
}

}  // namespace semigeo::recognition
