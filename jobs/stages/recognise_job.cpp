#include "jobs/stages/recognise_job.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

#include "io/dataset/dataset.hpp"
#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "io/scans/scan_reader.hpp"
#include "jobs/stages/recognised_file.hpp"
#include "jobs/stages/recognition_features.hpp"
#include "jobs/stages/resemblance.hpp"
#include "jobs/stages/scan_surface.hpp"
#include "jobs/stages/thesis_recognition.hpp"
#include "kernels/recognition/single_view.hpp"

namespace semigeo::jobs {
namespace {

constexpr int kMostLevels = 16;

/// Reads the features of a scene, and fills in the numbers of `scene`.
kernels::RecognitionModel read_scene(const RecogniseJob& job,
                                     const RecognitionParameters& parameters, double depth_jump,
                                     const engine::RunContext& context, RecognisedScene& scene) {
  if (io::is_scan_name(job.scene)) {
    const ScanSurface scan = read_surface(job.scene, job.input_xxh3, depth_jump);
    scene.format = scan.format;
    scene.repairs = scan.repairs;
    scene.vertices = scan.built.surface.vertex_count();
    scene.triangles = scan.built.surface.face_count();
    kernels::RecognitionModel model =
        recognition_model(scan.built, scene_parameters(parameters), context);
    if (scan.eye) model.eye = *scan.eye - model.origin;
    return model;
  }
  const io::Dataset dataset(job.scene);
  const io::LevelInfo level = dataset.level(0);
  scene.format = "dataset";
  scene.dataset_digest = dataset.digest();
  scene.vertices = level.vertices;
  scene.triangles = level.triangles;
  kernels::RecognitionModel model =
      recognition_model(dataset, scene_parameters(parameters), context);
  if (io::xxh3_of_file(job.scene) != job.input_xxh3)
    throw io::Error(job.scene, "", "the file changed while it was read", "run again");
  return model;
}

Recognition recognise(const io::HashLibrary& library, const kernels::RecognitionModel& scene,
                      const SearchParameters& parameters, const engine::RunContext& context) {
  // Nothing can be recognised in a scene without features.
  if (scene.features.features.empty()) return {};
  const RecognitionOptions options = {.min_score = parameters.min_score,
                                      .scale = scale_range(parameters.scale)};
  if (parameters.method == RecognitionMethod::kThesis)
    return thesis_recognition(library, scene, options, context);
  return recognise_scene(library, scene, options, context);
}

/// Tells whether a scene is open. Nothing but its majority says which side of it is outside.
bool is_open(const kernels::RecognitionModel& scene) {
  return std::ranges::find(scene.samples.rim, 1) != scene.samples.rim.end();
}

/// Finds out where a scene was scanned from, unless it is known or not wanted.
void find_view(ViewChoice choice, kernels::RecognitionModel& scene) {
  if (choice == ViewChoice::kNone)
    scene.eye.reset();
  else if (!scene.eye)
    scene.eye = kernels::eye_of_view(scene);
}

std::optional<Eigen::Vector3d> eye_in_file(const kernels::RecognitionModel& scene) {
  if (!scene.eye) return std::nullopt;
  return *scene.eye + scene.origin;
}

}  // namespace

RecognitionParameters parameters_of(const io::HashLibrary& library) {
  constexpr const char* kRemedy =
      "use the version of semigeo that made it, or build it anew: semigeo library build";
  try {
    const RecognitionParameters parameters = recognition_parameters_from_json(library.parameters());
    if (json_of(parameters) == library.parameters() && parameters.levels >= 1 &&
        parameters.levels <= kMostLevels && parameters.most_features >= 1 &&
        parameters.samples >= 1)
      return parameters;
  } catch (const std::runtime_error&) {
  }
  throw io::Error(
      library.path(), "",
      "was made with parameters that this version does not know: " + library.parameters().dump(),
      kRemedy);
}

double default_min_score(RecognitionMethod method) {
  return method == RecognitionMethod::kThesis ? 0 : RecognitionOptions{}.min_score;
}

RecogniseJobResult run_recognise_job(const RecogniseJob& job, const SearchParameters& parameters,
                                     const engine::RunContext& context) {
  const io::HashLibrary library(job.library);
  if (library.digest() != job.library_digest)
    throw io::Error(job.library, "", "the library has changed meanwhile", "run again");
  RecognisedScene scene = {.name = job.name, .input_name = job.input_name, .xxh3 = job.input_xxh3};
  kernels::RecognitionModel model =
      read_scene(job, parameters_of(library), parameters.depth_jump, context, scene);
  scene.features = static_cast<std::int64_t>(model.features.features.size());
  scene.samples = static_cast<std::int64_t>(model.samples.points.size());
  find_view(parameters.view, model);
  Recognition recognition = recognise(library, model, parameters, context);
  scene.eye = eye_in_file(model);
  if (recognition.objects.empty() && is_open(model)) {
    model = kernels::turned_over(std::move(model));
    find_view(parameters.view, model);
    Recognition turned = recognise(library, model, parameters, context);
    scene.turned = !turned.objects.empty();
    if (scene.turned) {
      recognition = std::move(turned);
      scene.eye = eye_in_file(model);
    }
  }
  if (parameters.resemblance) recognition.resemblance = resemblances(library, model, context);
  write_recognised(job.output, job.key, scene, library, parameters, recognition);
  return {.features = scene.features,
          .triplets = recognition.scene_triplets,
          .objects = static_cast<std::int64_t>(recognition.objects.size())};
}

}  // namespace semigeo::jobs
