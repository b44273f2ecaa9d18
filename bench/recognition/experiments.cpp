#include "bench/recognition/experiments.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>

#include "bench/recognition/diagnosis.hpp"
#include "bench/recognition/heap_scene.hpp"
#include "bench/recognition/model_library.hpp"
#include "bench/recognition/range_scan.hpp"
#include "bench/recognition/report.hpp"
#include "bench/recognition/scenes.hpp"

namespace semigeo::recognition {
namespace {

constexpr std::array kFalsePositiveKinds = {"A", "B", "C", "D", "E"};

/// Holds a library and the recogniser that uses it.
struct Opened {
  Opened(const ModelLibraries& libraries, const std::vector<std::size_t>& left_out,
         const Method& method)
      : library(libraries.without(left_out)),
        names(model_names(*library)),
        recogniser(method(*library)) {}

  std::unique_ptr<io::HashLibrary> library;
  std::vector<std::string> names;
  Recogniser recogniser;
};

class Experiments {
 public:
  Experiments(ModelSpan models, std::size_t known, const ModelLibraries& libraries,
              const Method& method, const ExperimentOptions& options,
              const std::function<void(const Outcome&)>& told, const engine::RunContext& context)
      : models_(models),
        known_(known),
        libraries_(libraries),
        method_(method),
        options_(options),
        told_(told),
        context_(context) {}

  void generated(const std::vector<std::string>& kinds) {
    std::optional<Opened> opened;
    for (const std::string& name : kinds) {
      const SceneKind* kind = scene_kind(name);
      if (kind == nullptr) continue;
      if (!opened) opened.emplace(libraries_, beyond_known(), method_);
      for (std::uint64_t s = 0; s < options_.seeds; ++s)
        for (std::size_t i = 0; i < known_; ++i)
          look(make_scene(*kind, known(), i, options_.first_seed + s), *opened);
    }
  }

  void range_scan(const Scene& scene) { look(scene, Opened(libraries_, {}, method_)); }

  /// Heaps whose objects no library has.
  void absent_heaps() {
    for (std::uint64_t s = 0; s < options_.seeds; ++s)
      for (int number = 0; number < options_.heaps; ++number) {
        Scene scene = make_heap_scene(known(), number, options_.first_seed + s);
        std::vector<std::size_t> left_out = beyond_known();
        for (const PlacedObject& object : scene.objects) left_out.push_back(object.model);
        scene.kind = kAbsent + scene.kind;
        scene.objects.clear();
        look(scene, Opened(libraries_, left_out, method_));
      }
  }

  void heaps() {
    const Opened opened(libraries_, beyond_known(), method_);
    for (std::uint64_t s = 0; s < options_.seeds; ++s)
      for (int number = 0; number < options_.heaps; ++number) {
        const Scene scene = make_heap_scene(known(), number, options_.first_seed + s);
        look(scene, opened, [&](const kernels::RecognitionModel& model, Outcome& outcome) {
          if (options_.diagnose) diagnose(scene, model, opened, outcome);
        });
      }
  }

  void false_positives() {
    for (std::size_t i = 0; i < known_; ++i) {
      std::vector<std::size_t> left_out = beyond_known();
      left_out.push_back(i);
      const Opened opened(libraries_, left_out, method_);
      for (const char* name : kFalsePositiveKinds)
        for (std::uint64_t s = 0; s < options_.seeds; ++s) {
          Scene scene = make_scene(*scene_kind(name), known(), i, options_.first_seed + s);
          scene.kind = kAbsent + scene.kind;
          scene.objects.clear();
          look(scene, opened);
        }
    }
  }

  std::vector<Outcome> take() { return std::move(outcomes_); }

 private:
  ModelSpan known() const { return models_.first(known_); }
  std::vector<std::size_t> beyond_known() const {
    std::vector<std::size_t> result;
    for (std::size_t i = known_; i < models_.size(); ++i) result.push_back(i);
    return result;
  }
  void look(const Scene& scene, const Opened& opened, const Inspector& inspect = {}) {
    outcomes_.push_back(try_scene(scene, models_, opened.names, opened.recogniser, inspect,
                                  options_.parameters, context_));
    told_(outcomes_.back());
  }
  /// Examines where the objects were lost that are not reported.
  void diagnose(const Scene& scene, const kernels::RecognitionModel& model, const Opened& opened,
                Outcome& outcome) const {
    if (outcome.reported()) return;
    const Diagnoser diagnoser(*opened.library, model, options_.recognition, context_);
    for (std::size_t i = 0; i < outcome.objects.size(); ++i) {
      ObjectOutcome& object = outcome.objects[i];
      const auto at = std::ranges::find(opened.names, object.model);
      if (!object.reported)
        object.diagnosis = diagnoser.diagnosis(at - opened.names.begin(), scene.objects[i].pose);
    }
  }

  ModelSpan models_;
  std::size_t known_;  ///< Number of models of the library. Others are for the range scan.
  const ModelLibraries& libraries_;
  const Method& method_;
  const ExperimentOptions& options_;
  const std::function<void(const Outcome&)>& told_;
  const engine::RunContext& context_;
  std::vector<Outcome> outcomes_;
};

}  // namespace

std::vector<std::string> model_names(const io::HashLibrary& library) {
  std::vector<std::string> names;
  for (const io::ModelInfo& model : library.models()) names.push_back(model.name);
  return names;
}

std::vector<Outcome> run_experiments(BenchModels& models, const Method& method,
                                     const ExperimentOptions& options,
                                     const std::filesystem::path& folder,
                                     const std::function<void(const Outcome&)>& told,
                                     const engine::RunContext& context) {
  const std::size_t known = models.size();
  const auto wanted = [&](const char* kind) { return std::ranges::count(options.kinds, kind) > 0; };
  std::optional<RangeScan> scan;
  if (wanted(kRangeScan))
    scan = read_range_scan(options.scan_folder, options.model_vertices, options.scan_vertices);
  if (scan) {
    scan->scene.objects.front().model = known;
    models.push_back(std::move(scan->model));
  }
  const ModelLibraries libraries(models, options.parameters, folder, context);
  Experiments experiments(models, known, libraries, method, options, told, context);
  experiments.generated(options.kinds);
  if (scan) experiments.range_scan(scan->scene);
  if (wanted(kHeap)) experiments.heaps();
  if (wanted(kAbsentHeaps)) experiments.absent_heaps();
  if (wanted(kFalsePositives)) experiments.false_positives();
  return experiments.take();
}

}  // namespace semigeo::recognition
