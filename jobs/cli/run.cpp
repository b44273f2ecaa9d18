#include <memory>
#include <string>

#include "io/files/atomic_file.hpp"
#include "io/files/error.hpp"
#include "io/scans/scan_reader.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/output.hpp"
#include "jobs/cli/run_plan.hpp"
#include "jobs/cli/surface_options.hpp"
#include "jobs/kinds/library_plan.hpp"
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
};

/// Writes the configuration into the archive if it has none yet, and records the scans of its
/// datasets. It is called before the jobs run, so that errors are reported before hours of work.
void prepare_archive(const fs::path& archive, const std::string& effective_config,
                     const std::vector<PlannedJob>& plan) {
  const fs::path config_file = archive / "semigeo.toml";
  if (!fs::exists(config_file)) io::write_file_atomically(config_file, effective_config);
  record_sources(archive, plan);
}

std::vector<PlannedJob> make_plan(const RunOptions& options, const std::vector<FoundScan>& scans,
                                  DigestCache& cache) {
  const fs::path& archive = options.archive;
  const int threads = options.execution.limits.threads;
  std::vector<PlannedJob> plan =
      plan_surfaces(archive, scans, options.surface.parameters, cache, threads);
  if (options.library)
    plan_library(plan, models_of(archive, plan, cache), place_of_archive(archive), {});
  if (options.execution.verify) {
    verify_surfaces(plan, threads);
    verify_library_plan(plan);
  }
  return plan;
}

int find_and_run(const RunOptions& options, const std::string& effective_config) {
  FoundScans found;
  try {
    found = find_scans(options.inputs, options.archive);
  } catch (const io::Error& e) {
    complain(e);
    return kUsage;
  }
  if (found.scans.empty()) {
    complain("no ", io::scan_extensions(", ", " or "), " file (or .gz of one) was found");
    return kUsage;
  }
  return run_plan(
      options.execution,
      {.home = options.archive,
       .plan = [&](DigestCache& cache) { return make_plan(options, found.scans, cache); },
       .prepare =
           [&](const std::vector<PlannedJob>& plan) {
             prepare_archive(options.archive, effective_config, plan);
           },
       .passed_over = found.passed_over});
}

void add_options(CLI::App* command, RunOptions& options) {
  command
      ->add_option(
          "scans", options.inputs,
          "Scans (" + io::scan_extensions(" ", " ") + ", each also .gz) and folders of them")
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
