#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/files/error.hpp"
#include "io/scans/scan_reader.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/failures.hpp"
#include "jobs/cli/output.hpp"
#include "jobs/cli/recognise_report.hpp"
#include "jobs/cli/run_plan.hpp"
#include "jobs/cli/table_options.hpp"
#include "jobs/cli/temporary_folder.hpp"
#include "jobs/kinds/recognise_plan.hpp"
#include "jobs/stages/recognise_job.hpp"
#include "jobs/stages/recognised_file.hpp"

namespace semigeo::jobs::cli {
namespace {

namespace fs = std::filesystem;

struct RecogniseOptions {
  std::vector<fs::path> inputs;  ///< Scenes, and folders of them.
  ExecutionOptions execution;
  std::string library;
  std::string output;  ///< Folder for the results; empty: they are not kept.
  SearchParameters search;
  std::optional<double> min_score;  ///< Replaces that of `search` if it is given.
  std::size_t top = RecogniseReport{}.top;
};

void complete(RecogniseOptions& options) {
  complete(options.execution);
  if (options.output.empty() && options.execution.executor == ExecutorKind::kSlurm)
    throw CLI::ValidationError("--output", "give a folder that all machines see with Slurm");
  SearchParameters& search = options.search;
  search.min_score = options.min_score.value_or(default_min_score(search.method));
  if (!(search.min_score >= 0) || !std::isfinite(search.min_score))
    throw CLI::ValidationError("--min-score", "give a number that is not negative");
}

/// Finds the scenes. It does not search the folders of the library and the output, unless they are
/// inputs themselves, because their datasets are the models.
FoundScans scenes_of(const RecogniseOptions& options, const SearchedLibrary& library) {
  std::vector<fs::path> passed_over = {library.path.parent_path()};
  if (!options.output.empty()) passed_over.emplace_back(options.output);
  return find_scenes(options.inputs, passed_over);
}

int recognise(RecogniseOptions& options) {
  const SearchedLibrary library = searched_library(options.library);
  FoundScans scenes;
  try {
    scenes = scenes_of(options, library);
  } catch (const io::Error& e) {
    complain(e);
    return kUsage;
  }
  if (scenes.scans.empty()) {
    complain("no scan (", io::scan_extensions(", ", " or "),
             ", or .gz of one) and no dataset (.vtkhdf) was found");
    return kUsage;
  }
  std::optional<TemporaryFolder> temporary;
  if (options.output.empty()) temporary.emplace();
  const fs::path folder = temporary ? temporary->path() : fs::path(options.output);
  const RecogniseReport report = {
      .top = options.top,
      .failures_were_told = !options.execution.quiet && outputs_are_one_place(),
      .has_files = !temporary,
      .passed_over = scenes.passed_over};
  return run_plan(
      options.execution,
      {.home = folder,
       .plan =
           [&](DigestCache&) {
             return plan_recognition(scenes.scans, library, options.search, folder,
                                     options.execution.limits.threads);
           },
       .prepare = [&](const std::vector<PlannedJob>& plan) { record_scenes(folder, plan); },
       .is_archive = false,
       .is_kept = !temporary,
       .print =
           [&](const RunResult& result) {
             const auto print = options.execution.json ? print_recognised_json : print_recognised;
             print(result, library, report);
           },
       .notes = [&] { return RunNotes{.passed_over = scenes.passed_over}; }});
}

void add_options(CLI::App* command, RecogniseOptions& options) {
  command
      ->add_option("scenes", options.inputs,
                   "Scans (" + io::scan_extensions(" ", " ") +
                       ", each also .gz, .bz2,\n.xz or .zst), datasets (.vtkhdf), and folders or "
                       "containers\n(.zip, .7z, .tar, .tar.gz) of them")
      ->default_str("")
      ->required()
      ->configurable(false);
  command
      ->add_option("--library", options.library,
                   "The library, or an archive that has one: ARCHIVE/library.h5")
      ->required()
      ->configurable(false);
  command
      ->add_option(
          "-o,--output", options.output,
          "Keep what was recognised: FOLDER/recognised/<scene>.json. What is there and up\n"
          "to date is not computed again. The folder may be an archive")
      ->configurable(false);
  add_table_options(*command, search_parameter_table(), options.search);
  command
      ->add_option("--min-score", options.min_score,
                   "A model with less is not in the scene; 0 names the best, whatever it is")
      ->default_str("");
  command
      ->add_option("--top", options.top,
                   "Models of the ranking to print; " + std::to_string(kMostRanked) + " at most")
      ->check(CLI::Range(std::size_t{0}, kMostRanked));
  add_execution_options(*command, options.execution);
}

}  // namespace

void add_recognise(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RecogniseOptions>();
  CLI::App* command =
      app.add_subcommand("recognise", "Say which models of a library are in a scene, and where");
  command->alias("recognize");
  command->footer(
      "Examples:\n"
      "  semigeo recognise scene.ply --library archive      in archive/library.h5\n"
      "  semigeo recognise scenes/ --library mine.h5 --output found\n"
      "                                                     keeps found/recognised/<scene>.json\n"
      "  semigeo recognise scene.ply --library mine.h5 --json --top 20\n"
      "\n"
      "A pose leads from the model's coordinates to the scene's, in the units of their files: a\n"
      "4 x 4 matrix for column vectors; and scale, translation d h q and angles gamma beta alpha\n"
      "with R = Rz(alpha) Ry(beta) Rx(gamma). Exit codes: 0 all scenes were looked at, whether or\n"
      "not something is in them, 1 some failed, 2 usage, 73 another run has the folder, 75 "
      "stopped\n"
      "early: run again to go on.\n");
  add_options(command, *options);
  command->fallthrough();
  command->callback([options, &exit_code] {
    complete(*options);
    exit_code = recognise(*options);
  });
}

}  // namespace semigeo::jobs::cli
