#include <sys/resource.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>

#include "io/atomic_file.hpp"
#include "io/error.hpp"
#include "io/utf8.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/json_output.hpp"
#include "jobs/local_executor.hpp"

namespace semigeo::jobs::cli {
namespace {

namespace fs = std::filesystem;

/// Levels at most under --schedule octaves: then a patch reaches over a thousand edges.
constexpr int kMostOctaveLevels = 16;

struct RunOptions {
  RunConfig config;
  std::string surface = "curved";
  std::string coordinates = "semigeodesic";
  std::string schedule = "uniform";
  std::string decimate;
  std::string rescale = "size";
  bool no_remesh = false;
  int level = -1;  ///< not told
  std::string compression = "deflate";
  bool json = false;
  bool dry_run = false;
  bool verify = false;
};

/// Counts and costs of a run, for its last line.
struct RunSummary {
  std::int64_t done = 0;
  std::int64_t up_to_date = 0;
  std::int64_t failed = 0;
  std::int64_t vertex_levels = 0;
  double wall_seconds = 0;
  double cpu_seconds = 0;
  double peak_bytes = 0;
  double rate() const {
    return wall_seconds > 0 ? static_cast<double>(vertex_levels) / wall_seconds : 0;
  }
};

void measure_process(RunSummary& summary) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  summary.cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  summary.peak_bytes = 1024.0 * static_cast<double>(usage.ru_maxrss);
}

nlohmann::json scan_json(const PlannedJob& planned) {
  return {{"name", planned.job.name},
          {"input", planned.job.input.string()},
          {"output", planned.job.output.string()}};
}

bool is_readable(const PlannedJob& planned) {
  return planned.error.empty();
}

void print_plan(const std::vector<PlannedJob>& plan, bool json) {
  if (json) {
    auto scans = nlohmann::json::array();
    for (const PlannedJob& p : plan) {
      auto scan = scan_json(p);
      scan["state"] = p.up_to_date ? "up to date" : p.error.empty() ? "would run" : "unreadable";
      if (!p.reason.empty()) scan["reason"] = p.reason;
      if (!p.error.empty()) scan["error"] = p.error;
      scans.push_back(std::move(scan));
    }
    print_document({{"scans", scans}});
    return;
  }
  for (const PlannedJob& p : plan) {
    if (p.up_to_date) continue;
    std::printf("%s: %s\n", p.job.name.c_str(),
                p.error.empty() ? ("would run: " + p.reason).c_str() : p.error.c_str());
  }
  const auto up_to_date = std::ranges::count_if(plan, &PlannedJob::up_to_date);
  const auto unreadable = std::ranges::count_if(plan, std::not_fn(is_readable));
  const auto all = static_cast<long long>(plan.size());
  std::printf("%lld scans: %lld would run, %lld up to date", all, all - up_to_date - unreadable,
              static_cast<long long>(up_to_date));
  if (unreadable > 0) std::printf(", %lld cannot be read", static_cast<long long>(unreadable));
  std::printf("\n");
}

const char* state_name(JobState state) {
  switch (state) {
    case JobState::kDone:
      return "done";
    case JobState::kUpToDate:
      return "up to date";
    case JobState::kFailed:
      break;
  }
  return "failed";
}

void print_json(const std::vector<PlannedJob>& plan, const std::vector<JobOutcome>& outcomes,
                const SurfaceParameters& parameters, const RunSummary& summary) {
  auto scans = nlohmann::json::array();
  for (std::size_t i = 0; i < plan.size(); ++i) {
    auto scan = scan_json(plan[i]);
    const JobOutcome& outcome = outcomes[i];
    scan["state"] = state_name(outcome.state);
    scan["seconds"] = outcome.seconds;
    if (!outcome.error.empty()) scan["error"] = outcome.error;
    if (outcome.result) {
      scan["format"] = outcome.result->format;
      scan["vertices"] = outcome.result->vertices;
      scan["triangles"] = outcome.result->triangles;
      scan["parts"] = outcome.result->parts;
      scan["levels"] = outcome.result->levels;
      scan["repairs"] = nlohmann::json::parse(to_json(outcome.result->repairs));
      scan["preparation"] =
          nlohmann::json::parse(to_json(outcome.result->preparation, parameters.preparation));
      scan["vanished"] = outcome.result->vanished;
      scan["remeshing"] = nlohmann::json::parse(to_json(outcome.result->remeshed));
    }
    scans.push_back(std::move(scan));
  }
  const nlohmann::json document = {{"scans", scans},
                                   {"done", summary.done},
                                   {"up_to_date", summary.up_to_date},
                                   {"failed", summary.failed},
                                   {"vertex_levels", summary.vertex_levels},
                                   {"vertex_levels_per_second", summary.rate()},
                                   {"wall_seconds", summary.wall_seconds},
                                   {"cpu_seconds", summary.cpu_seconds},
                                   {"peak_memory_bytes", summary.peak_bytes}};
  print_document(document);
}

std::string in_words(const PreparationResult& preparation) {
  const kernels::HoleCounts& holes = preparation.holes;
  std::string text;
  if (holes.loops > 0) {
    text = std::to_string(holes.filled) + " of " + std::to_string(holes.loops) + " holes filled";
    std::string left;
    const auto add = [&](std::int64_t count, const char* reason) {
      if (count > 0) left += (left.empty() ? "" : ", ") + std::to_string(count) + " " + reason;
    };
    add(holes.outer, "outer");
    add(holes.too_long, "too long");
    add(holes.unsplittable, "without a valid split");
    if (!left.empty()) text += " (left: " + left + ")";
  }
  if (preparation.removed_vertices > 0) {
    char distance[64];
    std::snprintf(distance, sizeof distance, "%.3g", preparation.distance.maximum);
    text += (text.empty() ? "" : ", ") + std::to_string(preparation.removed_vertices) +
            " vertices removed, at most " + distance + " from what is left";
  }
  return text.empty() ? "nothing to do" : text;
}

/// What became of a surface on its way through the levels, if it is worth a word.
std::string in_words(const SurfaceJobResult& result) {
  std::string text;
  const auto add = [&text](std::int64_t count, const char* one, const char* more) {
    if (count == 0) return;
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + (count == 1 ? one : more);
  };
  add(result.remeshed.torn, "neck torn", "necks torn");
  add(result.remeshed.dropped_parts, "part lost", "parts lost");
  if (result.vanished)
    text +=
        (text.empty() ? "" : "; ") + std::string("too thin for so many levels: it has vanished");
  return text;
}

/// One line a scan whose file had to be repaired, one that was prepared, one that fell into parts;
/// then the failures; then the totals.
void print_text(const std::vector<PlannedJob>& plan, const std::vector<JobOutcome>& outcomes,
                const RunSummary& summary) {
  for (std::size_t i = 0; i < plan.size(); ++i) {
    if (!outcomes[i].result || outcomes[i].result->repairs == kernels::SurfaceRepairs{}) continue;
    std::string changes;
    const auto repairs = nlohmann::json::parse(to_json(outcomes[i].result->repairs));
    for (const auto& [name, count] : repairs.items()) {
      if (count.get<std::int64_t>() == 0) continue;
      std::string words = name;
      std::replace(words.begin(), words.end(), '_', ' ');
      changes += (changes.empty() ? "" : ", ") + count.dump() + " " + words;
    }
    std::printf("repaired: %s: %s\n", plan[i].job.name.c_str(), changes.c_str());
  }
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const auto& result = outcomes[i].result;
    if (!result || result->preparation == PreparationResult{}) continue;
    std::printf("prepared: %s: %s\n", plan[i].job.name.c_str(),
                in_words(result->preparation).c_str());
  }
  for (std::size_t i = 0; i < plan.size(); ++i) {
    if (!outcomes[i].result) continue;
    const std::string words = in_words(*outcomes[i].result);
    if (!words.empty()) std::printf("evolved: %s: %s\n", plan[i].job.name.c_str(), words.c_str());
  }
  for (const JobOutcome& outcome : outcomes)
    if (outcome.state == JobState::kFailed) std::printf("failed: %s\n", outcome.error.c_str());
  const std::string rate =
      summary.vertex_levels > 0 ? short_number(summary.rate()) + " vertex levels/s; " : "";
  std::printf("%lld done, %lld up to date, %lld failed; %s%s wall, %s CPU, %.0f MB peak\n",
              static_cast<long long>(summary.done), static_cast<long long>(summary.up_to_date),
              static_cast<long long>(summary.failed), rate.c_str(),
              short_duration(summary.wall_seconds).c_str(),
              short_duration(summary.cpu_seconds).c_str(), summary.peak_bytes / 1e6);
}

/// Makes the folder and, the first time, the configuration in it, and notes whose datasets it
/// holds: what fails here fails before the hours of work.
void prepare_archive(const fs::path& archive, const std::string& effective_config,
                     const std::vector<PlannedJob>& plan) {
  std::error_code error;
  fs::create_directories(archive, error);
  if (error)
    throw io::Error(archive, "", "cannot be created: " + error.message(),
                    "check --output, its permissions and the free space");
  io::remove_stale_partials(archive);
  const fs::path config_file = archive / "semigeo.toml";
  if (!fs::exists(config_file)) io::write_file_atomically(config_file, effective_config);
  try {
    record_sources(archive, plan);
  } catch (const io::Error&) {
    // A read-only archive in which nothing is to be made may stay as it is.
    if (!std::ranges::all_of(plan, &PlannedJob::up_to_date)) throw;
  }
}

int run(const RunOptions& options, const std::string& effective_config) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<PlannedJob> plan;
  try {
    plan = plan_jobs(options.config);
  } catch (const io::Error& e) {
    std::fprintf(stderr, "semigeo: %s\n", e.what());
    return kUsage;
  }
  if (plan.empty()) {
    std::fprintf(stderr, "semigeo: no .ply, .obj, .off or .stl file (or .gz of one) was found\n");
    return kUsage;
  }
  if (options.verify) verify_plan(plan, options.config.threads);
  if (options.dry_run) {
    print_plan(plan, options.json);
    return std::ranges::all_of(plan, is_readable) ? kAllDone : kSomeFailed;
  }

  std::int64_t to_run = 0;
  std::uintmax_t bytes = 0;
  for (const PlannedJob& p : plan) {
    to_run += p.up_to_date ? 0 : 1;
    bytes += bytes_to_read(p);
  }
  prepare_archive(options.config.archive, effective_config, plan);
  engine::Workers workers(options.config.threads);
  RunSummary summary;
  std::vector<JobOutcome> outcomes;
  {
    Progress progress(to_run, bytes);
    outcomes = run_jobs(plan, options.config.surface, workers, progress);
    summary.vertex_levels = progress.vertex_levels();
  }
  for (const JobOutcome& outcome : outcomes) {
    summary.done += outcome.state == JobState::kDone;
    summary.up_to_date += outcome.state == JobState::kUpToDate;
    summary.failed += outcome.state == JobState::kFailed;
  }
  summary.wall_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  measure_process(summary);
  if (options.json) {
    print_json(plan, outcomes, options.config.surface, summary);
  } else {
    print_text(plan, outcomes, summary);
  }
  return summary.failed == 0 ? kAllDone : kSomeFailed;
}

/// CLI::Range lets it pass.
std::string refuse_nan(const std::string& text) {
  double value = 0;
  return CLI::detail::lexical_cast(text, value) && std::isnan(value) ? "give a number" : "";
}

/// "0.1" is in mean edge lengths, "0.1mm" in the length unit mm.
void set_tolerance(const std::string& text, SurfaceParameters& parameters) {
  if (text.empty()) return;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string unit(end, text.data() + text.size());
  if (error != std::errc() || !(value > 0) || !std::isfinite(value))
    throw CLI::ValidationError("--decimate", "give a positive number, alone or with a unit");
  if (!unit.empty() && unit != parameters.length_unit)
    throw CLI::ValidationError("--decimate", "the scans' unit is " + parameters.length_unit +
                                                 ", not " + unit + "; give --unit " + unit +
                                                 " if it is");
  parameters.preparation.decimate = value;
  parameters.preparation.decimate_in_length_units = !unit.empty();
}

/// The options that datasets depend on, as --config reads them.
std::string config_text(const RunOptions& options) {
  const SurfaceParameters& p = options.config.surface;
  std::string text = "# Effective configuration; use it again with --config.\n[run]\n";
  // JSON's numbers, booleans and strings are TOML's.
  const auto add = [&text](const char* name, const nlohmann::json& value) {
    text += std::string(name) + " = " + value.dump() + '\n';
  };
  add("fill-holes", p.preparation.fill_holes);
  add("decimate", options.decimate);
  add("target-vertices", p.preparation.target_vertices);
  add("levels", p.levels);
  add("surface", options.surface);
  add("coordinates", options.coordinates);
  add("schedule", options.schedule);
  add("rescale", options.rescale);
  add("no-remesh", options.no_remesh);
  add("principal", p.evolution.principal);
  add("step", p.evolution.step_factor);
  add("feature-radius", p.features.radius);
  add("feature-completeness", p.features.min_completeness);
  if (p.recognition_level) add("level", *p.recognition_level);
  add("compression", options.compression);
  add("unit", p.length_unit);
  return text;
}

/// What is done to a scan before it is smoothed.
void add_preparation_options(CLI::App* command, RunOptions& options) {
  SurfaceParameters& surface = options.config.surface;
  command
      ->add_option("--fill-holes", surface.preparation.fill_holes,
                   "Fill holes of at most so many edges; outer boundaries stay. 0: none")
      ->check(CLI::Range(0, 1000000));
  command->add_option("--decimate", options.decimate,
                      "Remove vertices that lie this close to their surroundings: in mean edge\n"
                      "lengths (0.1), or in the unit that --unit names (0.05mm)");
  command
      ->add_option("--target-vertices", surface.preparation.target_vertices,
                   "Remove vertices, nearest to their surroundings first, until so many are left.\n"
                   "0: no limit")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 31));
}

/// Levels, patches and steps.
void add_evolution_options(CLI::App* command, RunOptions& options) {
  SurfaceParameters& surface = options.config.surface;
  command->add_option("--levels", surface.levels, "Smoothing iterations; every level is stored")
      ->check(CLI::Range(0, 999));
  command
      ->add_option("--surface", options.surface,
                   "What patches sample: quadratic faces, or flat ones as in the thesis")
      ->check(CLI::IsMember({"curved", "flat"}));
  command
      ->add_option("--coordinates", options.coordinates,
                   "How patches are laid: a base line and its perpendiculars, or rays")
      ->check(CLI::IsMember({"semigeodesic", "polar"}));
  command
      ->add_option("--schedule", options.schedule,
                   "Sample distance from level to level: the same, as in the thesis, or growing\n"
                   "with the scale reached, so that two levels double it")
      ->check(CLI::IsMember({"uniform", "octaves"}));
  command
      ->add_option(
          "--rescale", options.rescale,
          "What each part gets back after a uniform smoothing: its size (radius of gyration),\n"
          "its mean edge length, as in the thesis, or nothing. Noise makes edges longer: noisy\n"
          "scans swell by the second")
      ->check(CLI::IsMember({"size", "edges", "none"}));
  command->add_flag("--no-remesh", options.no_remesh,
                    "Keep the connectivity of level 0: no odd triangles removed, no necks torn,\n"
                    "no small parts dropped");
  command->add_flag("--principal", surface.evolution.principal,
                    "Store principal curvatures and their directions as well");
  command
      ->add_option("--step", surface.evolution.step_factor,
                   "Sample distance of patches at level 0, in mean edge lengths")
      ->check(CLI::Range(0.05, 20.0))
      ->check(refuse_nan);
}

/// Maxima, and the level that counts.
void add_feature_options(CLI::App* command, RunOptions& options) {
  FeatureOptions& features = options.config.surface.features;
  command
      ->add_option(
          "--feature-radius", features.radius,
          "Maxima of curvature outdo all of their sign within so many scales of the level.\n"
          "0: only the ring of neighbours, as in the thesis")
      ->check(CLI::Range(0.0, 20.0))
      ->check(refuse_nan);
  command
      ->add_option("--feature-completeness", features.min_completeness,
                   "Vertices with less of their patch are no features: 1 is all of it")
      ->check(CLI::Range(0.0, 1.0))
      ->check(refuse_nan);
  command
      ->add_option("--level", options.level,
                   "The level for recognition; else that at which the number of features changes\n"
                   "least")
      ->default_str("")
      ->check(CLI::Range(0, 999));
}

/// How datasets are stored and labelled.
void add_storage_options(CLI::App* command, RunOptions& options) {
  SurfaceParameters& surface = options.config.surface;
  command->add_option("--compression", options.compression, "Of the stored arrays")
      ->check(CLI::IsMember({"deflate", "none"}));
  command->add_option("--unit", surface.length_unit, "Length unit of the scans, as a label")
      ->check([](const std::string& unit) -> std::string {
        if (!io::is_utf8(unit)) return "is not UTF-8; give a short name such as mm or inch";
        const bool plain = !unit.empty() && unit.size() <= 32 &&
                           unit.find_first_of("\"\\\n\r\t") == std::string::npos;
        return plain ? std::string() : "give a short name such as mm or inch";
      });
}

/// Turns the words that were given into parameters.
void apply_words(RunOptions& options) {
  SurfaceParameters& parameters = options.config.surface;
  set_tolerance(options.decimate, parameters);
  parameters.evolution.curved = options.surface == "curved";
  parameters.evolution.rescale = options.rescale == "size"    ? Rescale::size
                                 : options.rescale == "edges" ? Rescale::edges
                                                              : Rescale::none;
  parameters.evolution.remesh = !options.no_remesh;
  if (options.coordinates == "polar")
    parameters.evolution.coordinates = kernels::Coordinates::polar;
  if (options.schedule == "octaves") {
    parameters.evolution.schedule = Schedule::octaves;
    if (parameters.levels > kMostOctaveLevels)
      throw CLI::ValidationError("--levels",
                                 "two levels of --schedule octaves double the scale; "
                                 "give at most " +
                                     std::to_string(kMostOctaveLevels));
  }
  if (options.level > parameters.levels)
    throw CLI::ValidationError("--level", "the levels are 0 to " +
                                              std::to_string(parameters.levels) +
                                              "; give one of them, or more --levels");
  if (options.level >= 0) parameters.recognition_level = options.level;
  options.config.surface.compression =
      options.compression == "deflate" ? io::Compression::deflate : io::Compression::none;
}

}  // namespace

void add_run(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand(
      "run", "Make one multi-scale dataset per scan: ARCHIVE/scans/<name>.vtkhdf");
  command->footer(
      "Examples:\n"
      "  semigeo run scans/ --output archive             every scan below scans/, 8 smoothings\n"
      "  semigeo run a.ply b.stl.gz --output archive --levels 20 --unit mm\n"
      "  semigeo run scans/ --output archive --dry-run   what would run, and why\n"
      "  semigeo run scans/ --output archive --verify    also what the disk has damaged since\n"
      "\n"
      "What is up to date, by content, is left alone; a run that was interrupted goes on where it\n"
      "stopped. Options may also come from --config FILE. Exit codes: 0 all done, 1 some scans "
      "failed,\n"
      "2 usage.\n");
  RunConfig& config = options->config;
  command
      ->add_option("scans", config.inputs,
                   "Scans (.ply .obj .off .stl, each also .gz) and folders of them")
      ->default_str("")
      ->required()
      ->configurable(false);
  command->add_option("-o,--output", config.archive, "The archive: a folder, made if need be")
      ->required()
      ->configurable(false);
  add_preparation_options(command, *options);
  add_evolution_options(command, *options);
  add_feature_options(command, *options);
  add_storage_options(command, *options);
  command->add_option("--threads", config.threads, "Threads at once; 0: one per core")
      ->check(CLI::Range(0, 4096));
  command->add_flag("--json", options->json, "Results as JSON on stdout")->configurable(false);
  command
      ->add_flag("--verify", options->verify,
                 "Read every array of what counts as up to date; make again what is damaged")
      ->configurable(false);
  command->add_flag("--dry-run", options->dry_run, "Say what would run, and why; write nothing")
      ->configurable(false);
  command->fallthrough();
  command->callback([options, &exit_code] {
    apply_words(*options);
    exit_code = run(*options, config_text(*options));
  });
}

}  // namespace semigeo::jobs::cli
