#include "jobs/cli/search_run.hpp"

#include <cmath>

#include "io/files/error.hpp"
#include "io/scans/scan_reader.hpp"
#include "jobs/cli/conventions.hpp"
#include "jobs/cli/output.hpp"
#include "jobs/cli/run_plan.hpp"
#include "jobs/cli/temporary_folder.hpp"
#include "jobs/stages/recognise_job.hpp"

namespace semigeo::jobs::cli {
namespace {

namespace fs = std::filesystem;

/// Finds the scenes. It does not search the folders of the library and the output, unless they are
/// inputs themselves, because their datasets are the models.
FoundScans scenes_of(const SearchRun& run, const SearchedLibrary& library) {
  std::vector<fs::path> passed_over = {library.path.parent_path()};
  if (!run.output.empty()) passed_over.emplace_back(run.output);
  return find_scenes(run.inputs, passed_over);
}

}  // namespace

void add_search_places(CLI::App& command, const std::string& scenes, SearchRun& run) {
  command
      .add_option(scenes, run.inputs,
                  "Scans (" + io::scan_extensions(" ", " ") +
                      ", each also .gz, .bz2,\n.xz or .zst), datasets (.vtkhdf), and folders or "
                      "containers\n(.zip, .7z, .tar, .tar.gz) of them")
      ->default_str("")
      ->required()
      ->configurable(false);
  command
      .add_option("--library", run.library,
                  "The library, or an archive that has one: ARCHIVE/library.h5")
      ->required()
      ->configurable(false);
  command
      .add_option("-o,--output", run.output,
                  "Keep what was recognised: FOLDER/recognised/<scene>.json. What is there and up\n"
                  "to date is not computed again. The folder may be an archive")
      ->configurable(false);
}

void complete(SearchRun& run) {
  complete(run.execution);
  if (run.output.empty() && run.execution.executor == ExecutorKind::kSlurm)
    throw CLI::ValidationError("--output", "give a folder that all machines see with Slurm");
  SearchParameters& search = run.search;
  search.min_score = run.min_score.value_or(default_min_score(search.method));
  if (!(search.min_score >= 0) || !std::isfinite(search.min_score))
    throw CLI::ValidationError("--min-score", "give a number that is not negative");
}

int run_search(SearchRun& run,
               const std::function<void(const RunResult&, const Searched&)>& print) {
  const SearchedLibrary library = searched_library(run.library);
  FoundScans scenes;
  try {
    const InterruptibleSearch interruptible;
    scenes = scenes_of(run, library);
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
  if (run.output.empty()) temporary.emplace();
  const fs::path folder = temporary ? temporary->path() : fs::path(run.output);
  const Searched searched = {library, scenes.passed_over, !temporary};
  return run_plan(
      run.execution,
      {.home = folder,
       .plan =
           [&](DigestCache&) {
             return plan_recognition(scenes.scans, library, run.search, folder,
                                     run.execution.limits.threads);
           },
       .prepare = [&](const std::vector<PlannedJob>& plan) { record_scenes(folder, plan); },
       .is_archive = false,
       .is_kept = !temporary,
       .print = [&](const RunResult& result) { print(result, searched); },
       .notes = [&] { return RunNotes{.passed_over = scenes.passed_over}; }});
}

}  // namespace semigeo::jobs::cli
