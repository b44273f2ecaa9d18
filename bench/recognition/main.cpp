// How often objects are recognised in scenes: turned, cut, digitised anew, noisy, several at once.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bench/recognition/bench_model.hpp"
#include "bench/recognition/experiments.hpp"
#include "bench/recognition/heap_report.hpp"
#include "bench/recognition/heap_scene.hpp"
#include "bench/recognition/report.hpp"
#include "bench/recognition/scenes.hpp"
#include "bench/recognition/thesis_tables.hpp"
#include "bench/support/examples_first.hpp"
#include "io/files/atomic_file.hpp"
#include "jobs/stages/recognise_scene.hpp"
#include "jobs/stages/search_parameters.hpp"
#include "jobs/stages/thesis_recognition.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::recognition {
namespace {

namespace fs = std::filesystem;

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kUsage = 2;

struct Options {
  ModelChoice models;
  ExperimentOptions experiments;
  std::string method = "own";
  jobs::ThesisRecognitionOptions thesis;
  bool thesis_tables = false;
  bool short_run = false;
  bool verbose = false;
  fs::path json;
  int threads = 0;
};

std::vector<std::string> all_kinds() {
  std::vector<std::string> kinds;
  for (const SceneKind& kind : scene_kinds()) kinds.push_back(kind.name);
  kinds.insert(kinds.begin() + 6, kRangeScan);
  kinds.push_back(kFalsePositives);
  kinds.push_back(kHeap);
  kinds.push_back(kAbsentHeaps);
  return kinds;
}

/// Sets options for a short run: few objects, and some seconds.
void shorten(Options& options) {
  options.models.most_models = 4;
  options.models.most_vertices = options.experiments.model_vertices = 1500;
  options.experiments.seeds = 1;
  options.experiments.kinds = {"A", "B", "C", "F", "H", kFalsePositives};
}

Method method_of(const Options& options, const engine::RunContext& context) {
  if (options.method == "thesis")
    return [&options, &context](const io::HashLibrary& library) -> Recogniser {
      const auto database =
          std::make_shared<jobs::ThesisDatabase>(library, options.thesis, context);
      return [&options, database](const kernels::RecognitionModel& scene) {
        return jobs::ranked(database->scores(scene), options.experiments.recognition);
      };
    };
  return [&options, &context](const io::HashLibrary& library) -> Recogniser {
    return [&](const kernels::RecognitionModel& scene) {
      return jobs::recognise_scene(library, scene, options.experiments.recognition, context);
    };
  };
}

void tell(const Outcome& o) {
  std::fprintf(stderr, "%-5s %-28s seed %llu: %s%s%s, first %s, %d false, %.2f s + %.2f s\n",
               o.kind.c_str(), o.scene.c_str(), static_cast<unsigned long long>(o.seed),
               o.named() ? "named" : "-", o.posed() ? ", posed" : "",
               o.reported() ? ", reported" : "", o.first.c_str(), o.false_objects,
               o.scale_space.wall, o.search.wall);
}

int run(Options options, const std::vector<std::string>& arguments) {
  if (options.short_run) shorten(options);
  if (options.models.as_in_heaps)
    options.experiments.recognition.scale = jobs::scale_range("known");
  if (options.method == "thesis" || options.thesis_tables)
    options.experiments.parameters.torsion = true;
  engine::Workers workers(options.threads);
  engine::Observer observer;
  const engine::RunContext context{workers, observer, {}};
  options.experiments.model_vertices = options.models.most_vertices;
  options.experiments.diagnose = options.method == "own";
  std::vector<SkippedModel> skipped;
  BenchModels models = read_models(options.models, skipped);
  if (options.verbose)
    for (const SkippedModel& model : skipped)
      std::fprintf(stderr, "recognition: %s: skipped: %s\n", model.path.c_str(), model.why.c_str());
  if (models.empty()) throw std::runtime_error("no closed mesh among the models");
  const std::size_t known = models.size();  // the range scan may add one
  const tests::TemporaryFolder folder;
  if (options.thesis_tables) {
    const ThesisTables tables =
        thesis_tables(models, options.experiments.parameters, options.thesis,
                      options.experiments.first_seed, folder.path(), context);
    print(tables);
    if (!options.json.empty()) io::write_file_atomically(options.json, json(tables));
    return kDone;
  }
  const std::vector<Outcome> outcomes = run_experiments(
      models, method_of(options, context), options.experiments, folder.path(),
      options.verbose ? tell : [](const Outcome&) {}, context);
  std::printf("%zu models; %zu files left out%s\n", known, skipped.size(),
              skipped.empty() || options.verbose ? "" : " (--verbose says why)");
  print(outcomes);
  print_heaps(outcomes, options.experiments.recognition.min_score);
  print_misses(outcomes);
  std::vector<std::string> names;
  for (const auto& model : models) names.push_back(model->name);
  if (!options.json.empty())
    io::write_file_atomically(options.json, json(outcomes, arguments, names));
  return kDone;
}

void add_options(CLI::App& app, Options& options) {
  ExperimentOptions& e = options.experiments;
  const std::vector<std::string> kinds = all_kinds();
  e.kinds = kinds;
  std::erase_if(e.kinds, [](const std::string& k) { return k == kHeap || k == kAbsentHeaps; });
  options.models.places = {SEMIGEO_REAL_SCANS};
  e.scan_folder = SEMIGEO_REAL_SCANS;
  app.add_option("--models", options.models.places, "Files and folders; closed meshes are used")
      ->check(CLI::ExistingPath);
  app.add_option("--model-vertices", options.models.most_vertices, "At most; 0: as they are")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{100'000'000}));
  app.add_option("--most-models", options.models.most_models, "0: all")
      ->check(CLI::Range(0, 1'000'000));
  app.add_option("--kinds", e.kinds, "Of scenes")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(kinds));
  app.add_option("--seeds", e.seeds, "Scenes of each kind and object")->check(CLI::Range(1, 1000));
  app.add_option("--seed", e.first_seed, "The first");
  app.add_option("--heaps", e.heaps, "Scenes of kinds R and XR of each seed")
      ->check(CLI::Range(1, 1000));
  app.add_flag("--known-scale", options.models.as_in_heaps,
               "R and XR: objects have the size of their models, and others are left out");
  app.add_option("--scans", e.scan_folder, "Folder with the files of G");
  app.add_option("--scan-vertices", e.scan_vertices, "Of G's scene, at most; 0: as it is")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{100'000'000}));
  app.add_option("--levels", e.parameters.levels, "Of features")->check(CLI::Range(1, 20));
  app.add_option("--most-features", e.parameters.most_features, "Of each level and kind")
      ->check(CLI::Range(3, 10000));
  app.add_flag("--torsion,!--no-torsion", e.parameters.torsion, "Features of torsion too")
      ->capture_default_str();
  app.add_option("--samples", e.parameters.samples, "Of a surface, at most")
      ->check(CLI::Range(10, 1'000'000));
  app.add_option("--min-score", e.recognition.min_score, "Below it nothing is reported");
  app.add_option("--method", options.method, "thesis: all triplets, votes, clusters of poses")
      ->check(CLI::IsMember({"own", "thesis"}));
  app.add_option("--strongest", options.thesis.hash.strongest, "thesis: features of each kind")
      ->check(CLI::Range(3, 1000));
  app.add_option("--level", options.thesis.level, "thesis: of the features");
  app.add_flag("--thesis-tables", options.thesis_tables,
               "Instead: tables 6.1 to 6.6 of the thesis, with these models");
  app.add_flag("--short", options.short_run, "Four small models, a few kinds, one seed");
  app.add_option("--json", options.json, "Every scene");
  app.add_flag("--verbose", options.verbose, "Each scene as it is done, on stderr");
  app.add_option("--threads", options.threads, "0: one per core")->check(CLI::Range(0, 4096));
}

std::string footer() {
  std::string text =
      "Examples:\n"
      "  recognition --models scans --kinds A,B,C --verbose\n"
      "  recognition --models a.ply b.obj c.stl --seeds 5 --json rates.json\n"
      "  recognition --models scans --method thesis --kinds A,C\n"
      "  recognition --models scans --most-models 12 --thesis-tables\n"
      "\n"
      "Kinds of scenes, each rotated, scaled and moved as well:\n";
  for (const SceneKind& kind : scene_kinds())
    text += std::string("  ") + kind.name + std::string(5 - std::string(kind.name).size(), ' ') +
            kind.says + "\n";
  text +=
      "  G    a real range scan, if its files are there\n"
      "  X    A to E, of an object that the library does not have\n"
      "  R    a heap of three to six objects, scanned from one side; only if it is asked for\n"
      "  XR   R, of objects that the library does not have; only if it is asked for\n"
      "named: first in the ranking, or the first three for three objects; posed: with the right "
      "pose;\nreported: all among the objects found, with the right poses; false: objects found "
      "that are not\nthere, and in how many scenes. A pose is right within 5 degrees, 5 % of the "
      "diagonal and 5 % of\nscale, or if the surface is within 1 % of the diagonal, as that of "
      "symmetric objects.\n";
  return text;
}

}  // namespace
}  // namespace semigeo::recognition

int main(int argc, char** argv) {
  using namespace semigeo::recognition;
  CLI::App app{"How often objects are recognised in scenes.", "recognition"};
  app.formatter(std::make_shared<semigeo::bench::ExamplesFirst>());
  app.footer(footer());
  app.option_defaults()->always_capture_default();
  Options options;
  add_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? kDone : kUsage;
  }
  try {
    return run(std::move(options), std::vector<std::string>(argv + 1, argv + argc));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "recognition: %s\n", e.what());
    return kFailed;
  }
}
