#include <algorithm>
#include <iterator>
#include <memory>
#include <set>
#include <string>

#include "io/files/atomic_file.hpp"
#include "io/files/error.hpp"
#include "io/files/read_error.hpp"
#include "io/scans/scan_reader.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/leftovers_report.hpp"
#include "jobs/cli/output.hpp"
#include "jobs/cli/report_pages.hpp"
#include "jobs/cli/run_plan.hpp"
#include "jobs/cli/surface_options.hpp"
#include "jobs/kinds/library_plan.hpp"
#include "jobs/kinds/report_plan.hpp"
#include "jobs/kinds/surface_plan.hpp"

namespace semigeo::jobs::cli {
namespace {

namespace fs = std::filesystem;

/// The options of the command.
struct RunOptions {
  std::vector<fs::path> inputs;  ///< Scans, and folders of them.
  fs::path archive;
  SurfaceOptions surface;
  ExecutionOptions execution;
  bool library = false;  ///< A library of all datasets of the archive is made as well.
  bool report = false;   ///< Pages for a browser are made as well.
  bool prune = false;    ///< What is of scans that are gone is removed.
};

/// Finds and removes what the archive has of scans that are gone from the folders of a run.
class Pruning {
 public:
  explicit Pruning(const RunOptions& options) : options_(options) {
    std::ranges::copy_if(options.inputs, std::back_inserter(folders_),
                         [](const fs::path& input) { return io::is_folder(input); });
  }

  /// Looks for leftovers when it is known which names the scans of the run have.
  void find(const std::vector<PlannedJob>& surfaces) {
    std::set<std::string> in_use;
    for (const PlannedJob& planned : surfaces) in_use.insert(planned.job.name);
    found_ = find_leftovers(options_.archive, folders_, in_use);
    left_ = found_.list;
  }

  /// Takes out the models whose datasets are going to be removed.
  void leave_out(std::vector<LibraryModel>& models) const {
    if (!removes()) return;
    std::set<std::string> gone;
    for (const Leftover& leftover : found_.list)
      if (leftover.kind == Leftover::Kind::kDataset) gone.insert(leftover.name);
    std::erase_if(models, [&](const LibraryModel& model) { return gone.contains(model.name); });
  }

  /// Removes the leftovers. The jobs run even if some cannot be removed.
  void remove() {
    if (!options_.prune) return;
    if (!found_.emptied.empty()) complain(reason_to_ask(found_));
    if (!found_.unknown.empty()) complain(reason_to_look_again(found_));
    if (!removes()) return;
    try {
      Removal removal = remove_leftovers(options_.archive, found_);
      removed_ = std::move(removal.removed);
      left_ = std::move(removal.left);
      for (const io::Error& failure : removal.failures) complain(failure);
    } catch (const io::Error& e) {
      complain(e);
    }
  }

  JobSummary told() const {
    JobSummary told;
    if (!removed_.empty()) {
      told.fields.emplace_back("pruned", leftovers_json(removed_));
      told.text = "pruned: " + counts_in_words(removed_);
    }
    if (!left_.empty()) {
      told.fields.emplace_back("leftovers", leftovers_json(left_));
      if (!told.text.empty()) told.text += '\n';
      told.text += "leftovers: " + counts_in_words(left_) +
                   "; to remove them: " + prune_command(options_.archive, folders_);
    }
    return told;
  }

 private:
  bool removes() const { return options_.prune && found_.emptied.empty(); }

  const RunOptions& options_;
  std::vector<fs::path> folders_;
  Leftovers found_;
  std::vector<Leftover> removed_;
  std::vector<Leftover> left_;
};

/// Writes the configuration into the archive if it has none yet, and records the scans of its
/// datasets. It is called before the jobs run, so that errors are reported before hours of work.
void prepare_archive(const fs::path& archive, const std::string& effective_config,
                     const std::vector<PlannedJob>& plan) {
  const fs::path config_file = archive / "semigeo.toml";
  if (!io::is_there(config_file)) io::write_file_atomically(config_file, effective_config);
  record_sources(archive, plan);
}

std::vector<PlannedJob> make_plan(const RunOptions& options, const std::vector<FoundScan>& scans,
                                  DigestCache& cache, Pruning& pruning) {
  const fs::path& archive = options.archive;
  const int threads = options.execution.limits.threads;
  std::vector<PlannedJob> plan =
      plan_surfaces(archive, scans, options.surface.parameters, cache, threads);
  pruning.find(plan);
  std::vector<LibraryModel> models;
  if (options.library || options.report) models = models_of(archive, plan, cache);
  pruning.leave_out(models);
  if (options.library) plan_library(plan, models, place_of_archive(archive), {});
  if (options.execution.verify) {
    verify_surfaces(plan, threads);
    verify_library_plan(plan);
  }
  if (options.report)
    plan_report(plan, models, {.archive = archive, .folder = report_folder(archive)});
  return plan;
}

int find_and_run(const RunOptions& options, const std::string& effective_config) {
  if (options.report && lacks_pages()) return kUsage;
  FoundScans found;
  try {
    const InterruptibleSearch interruptible;
    found = find_scans(options.inputs, options.archive);
  } catch (const io::Error& e) {
    complain(e);
    return kUsage;
  }
  if (found.scans.empty()) {
    complain("no ", io::scan_extensions(", ", " or "), " file (or .gz of one) was found");
    return kUsage;
  }
  Pruning pruning(options);
  return run_plan(
      options.execution,
      {.home = options.archive,
       .plan = [&](DigestCache& cache) { return make_plan(options, found.scans, cache, pruning); },
       .prepare =
           [&](const std::vector<PlannedJob>& plan) {
             prepare_archive(options.archive, effective_config, plan);
             pruning.remove();
           },
       .passed_over = found.passed_over,
       .must_write = options.prune,
       .notes =
           [&] {
             return RunNotes{found.passed_over, pruning.told()};
           }});
}

void add_options(CLI::App* command, RunOptions& options) {
  command
      ->add_option("scans", options.inputs,
                   "Scans (" + io::scan_extensions(" ", " ") +
                       ", each also .gz, .bz2, .xz or\n"
                       ".zst), folders and containers (.zip, .7z, .tar, .tar.gz) of them")
      ->default_str("")
      ->required()
      ->configurable(false);
  command->add_option("-o,--output", options.archive, "The archive: a folder, made if need be")
      ->required()
      ->configurable(false);
  add_surface_options(*command, options.surface);
  command->add_flag(
      "--library", options.library,
      "Also build ARCHIVE/library.h5, in which scenes are recognised, of all datasets\n"
      "of the archive");
  command->add_flag("--report", options.report,
                    "Also make pages for a browser, as `semigeo report` does: "
                    "ARCHIVE/report/index.html");
  command->add_flag("--prune", options.prune,
                    "Also remove what the archive has of scans that are gone from the folders, as\n"
                    "`semigeo prune` does");
  add_execution_options(*command, options.execution);
}

void complete(RunOptions& options) {
  complete(options.execution);
  complete(options.surface);
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
      "  semigeo run scans/ --output archive --dry-run --explain   what differs\n"
      "  semigeo run scans/ --output archive --verify    also what the disk has damaged since\n"
      "  semigeo run scans/ --output archive --library   and a hash library of all datasets\n"
      "  semigeo run scans/ --output archive --report    and pages for a browser\n"
      "  semigeo run scans/ --output archive --prune     removes what is of scans that are gone\n"
      "  semigeo run scans/ --output archive --executor slurm --slurm-option partition=long\n"
      "  semigeo run scans/ --output archive --executor slurm --no-wait   run again to see the "
      "rest\n"
      "\n"
      "What is up to date, by content, is left alone; a run that was interrupted goes on where it\n"
      "stopped. Options may also come from --config FILE. Exit codes: 0 all done, 1 some scans "
      "failed,\n"
      "2 usage, 73 another run has the archive, 75 stopped early: run again to go on. The first\n"
      "Ctrl-C lets the running jobs end, the second ends them.\n");
  add_options(command, *options);
  command->fallthrough();
  command->callback([options, &exit_code] {
    complete(*options);
    exit_code = find_and_run(*options, config_text(options->surface));
  });
}

}  // namespace semigeo::jobs::cli
