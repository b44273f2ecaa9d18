#include "jobs/cli/run_options.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <map>
#include <nlohmann/json.hpp>

#include "io/files/utf8.hpp"

namespace semigeo::jobs::cli {
namespace {

/// Levels at most under --schedule octaves: then a patch reaches over a thousand edges.
constexpr int kMostOctaveLevels = 16;

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

/// What is done to a scan before it is smoothed.
void add_preparation_options(CLI::App* command, RunOptions& options) {
  SurfaceParameters& surface = options.config.jobs.surface;
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
  SurfaceParameters& surface = options.config.jobs.surface;
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
  FeatureOptions& features = options.config.jobs.surface.features;
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
  SurfaceParameters& surface = options.config.jobs.surface;
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

/// What the run and its jobs may take. None of it changes a byte of what comes out.
void add_executor_options(CLI::App* command, RunOptions& options) {
  ExecutorOptions& executor = options.executor;
  const CLI::AsSizeValue size(false);
  const CLI::AsNumberWithUnit duration(
      std::map<std::string, double>{{"s", 1}, {"min", 60}, {"m", 60}, {"h", 3600}, {"d", 86400}},
      CLI::AsNumberWithUnit::UNIT_OPTIONAL, "DURATION");
  command
      ->add_option("--threads", options.config.threads,
                   "Threads of all jobs at once; 0: one per core")
      ->check(CLI::Range(0, 4096));
  command
      ->add_option("--memory", executor.memory_bytes,
                   "Memory of all jobs that run side by side (8G); 0: what is free")
      ->transform(size);
  command
      ->add_option("--memory-per-job", executor.memory_per_job,
                   "Address space of one job (2G); 0: several times what it should need")
      ->transform(size);
  command
      ->add_option("--timeout", executor.timeout_seconds,
                   "End a job that takes longer (30min); 0: many times what it should take")
      ->transform(duration);
  command->add_option("--retries", executor.retries, "Of a job that crashed, or that a limit ended")
      ->check(CLI::Range(0, 100));
  CLI::Option* keep_going =
      command->add_flag("--keep-going", options.keep_going, "Go on when jobs fail: the default");
  command->add_flag("--fail-fast", executor.fail_fast, "Start nothing after the first failure")
      ->excludes(keep_going);
  command
      ->add_option("--time-limit", executor.most_seconds,
                   "Start nothing that will not end in time (8h); 0: no limit")
      ->transform(duration)
      ->configurable(false);
  command->add_option("--until", options.until, "Likewise, by the clock on the wall (06:00)")
      ->configurable(false);
}

/// Where jobs run, if not here.
void add_slurm_options(CLI::App* command, RunOptions& options) {
  command
      ->add_option("--executor", options.where,
                   "Where jobs run: here, or as an array job of Slurm, where --threads (0: one),\n"
                   "--memory, --retries, ... hold for each task")
      ->check(CLI::IsMember({"local", "slurm"}));
  command
      ->add_option("--scans-per-task", options.slurm.scans_per_task,
                   "Scans of one task of Slurm; 0: so that it lasts about five minutes")
      ->check(CLI::Range(0, 1000000));
  command
      ->add_option("--slurm-option", options.slurm.sbatch_options,
                   "Passed on to sbatch (account=geo); may be repeated")
      ->default_str("")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      ->add_flag(
          "--no-wait", [&options](std::int64_t) { options.slurm.wait = false; },
          "Print the numbers of Slurm's jobs, and end. A later run picks up what is missing")
      ->configurable(false);
}

/// Seconds until the clock shows HH:MM next.
double seconds_until(const std::string& clock) {
  int hours = 0;
  int minutes = 0;
  char rest = 0;
  if (std::sscanf(clock.c_str(), "%2d:%2d%c", &hours, &minutes, &rest) != 2 || hours < 0 ||
      hours > 23 || minutes < 0 || minutes > 59)
    throw CLI::ValidationError("--until", "give a time of day such as 06:00");
  const std::time_t now = std::time(nullptr);
  std::tm day = *std::localtime(&now);
  day.tm_hour = hours;
  day.tm_min = minutes;
  day.tm_sec = 0;
  day.tm_isdst = -1;
  std::time_t then = std::mktime(&day);
  if (then <= now) {
    ++day.tm_mday;
    day.tm_isdst = -1;
    then = std::mktime(&day);
  }
  return std::difftime(then, now);
}

}  // namespace

void add_run_options(CLI::App* command, RunOptions& options) {
  RunConfig& config = options.config;
  command
      ->add_option("scans", config.inputs,
                   "Scans (.ply .obj .off .stl, each also .gz) and folders of them")
      ->default_str("")
      ->required()
      ->configurable(false);
  command->add_option("-o,--output", config.archive, "The archive: a folder, made if need be")
      ->required()
      ->configurable(false);
  add_preparation_options(command, options);
  add_evolution_options(command, options);
  add_feature_options(command, options);
  add_storage_options(command, options);
  command->add_flag(
      "--library", options.library,
      "Also build ARCHIVE/library.h5, in which scenes are recognised, of all datasets\n"
      "of the archive");
  add_job_options(command, options);
}

void add_job_options(CLI::App* command, RunOptions& options) {
  add_executor_options(command, options);
  add_slurm_options(command, options);
  command->add_flag("--json", options.json, "Results as JSON on stdout")->configurable(false);
  command
      ->add_flag("--verify", options.verify,
                 "Read every array of what counts as up to date; make again what is damaged")
      ->configurable(false);
  command->add_flag("--dry-run", options.dry_run, "Say what would run, and why; write nothing")
      ->configurable(false);
  command
      ->add_flag("--explain", options.explain,
                 "Name everything because of which a scan is done: parameters, old and new, ...")
      ->configurable(false);
  command
      ->add_option("--dag", options.dag,
                   "Print the graph of files and jobs, for Graphviz or as JSON; run nothing")
      ->default_str("")
      ->check(CLI::IsMember({"dot", "json"}))
      ->configurable(false);
}

void apply_words(RunOptions& options) {
  if (options.where != "slurm" && !options.slurm.wait)
    throw CLI::ValidationError("--no-wait", "give --executor slurm with it");
  if (!options.until.empty()) {
    const double left = seconds_until(options.until);
    double& most = options.executor.most_seconds;
    most = most > 0 ? std::min(most, left) : left;
  }
  SurfaceParameters& parameters = options.config.jobs.surface;
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
  options.config.jobs.surface.compression =
      options.compression == "deflate" ? io::Compression::deflate : io::Compression::none;
}

std::string config_text(const RunOptions& options) {
  const SurfaceParameters& p = options.config.jobs.surface;
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

}  // namespace semigeo::jobs::cli
