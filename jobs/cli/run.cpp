#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <string>

#include "io/atomic_file.hpp"
#include "io/error.hpp"
#include "jobs/archive_lock.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/run_options.hpp"
#include "jobs/cli/run_report.hpp"
#include "jobs/estimates.hpp"
#include "jobs/local_executor.hpp"
#include "jobs/plan_graph.hpp"
#include "jobs/process_usage.hpp"
#include "jobs/run_journal.hpp"

namespace semigeo::jobs::cli {
namespace {

namespace fs = std::filesystem;

/// The archive, made if need be, for this run alone. Throws LockedError if another run has it. If
/// it cannot be written there is no lock but a reason: where nothing is to be made that is fine.
struct Possession {
  std::optional<ArchiveLock> lock;
  std::exception_ptr unwritable;

  explicit Possession(const fs::path& archive) {
    try {
      make_folder(archive);
      lock.emplace(archive);
    } catch (const LockedError&) {
      throw;
    } catch (const io::Error&) {
      unwritable = std::current_exception();
    }
  }

 private:
  static void make_folder(const fs::path& archive) {
    std::error_code error;
    fs::create_directories(archive, error);
    if (error)
      throw io::Error(archive, "", "cannot be created: " + error.message(),
                      "check --output, its permissions and the free space");
  }
};

/// The first time, puts the configuration into the archive; notes whose datasets it holds. What
/// fails here fails before the hours of work.
void prepare_archive(const fs::path& archive, const std::string& effective_config,
                     const std::vector<PlannedJob>& plan) {
  io::remove_stale_partials(archive);
  const fs::path config_file = archive / "semigeo.toml";
  if (!fs::exists(config_file)) io::write_file_atomically(config_file, effective_config);
  record_sources(archive, plan);
}

std::vector<PlannedJob> make_plan(const RunOptions& options, const std::vector<FoundScan>& scans,
                                  DigestCache& cache) {
  // What is to be verified is not taken from memory.
  cache = options.verify ? DigestCache(options.config.archive)
                         : DigestCache::read(options.config.archive);
  std::vector<PlannedJob> plan = plan_jobs(options.config, scans, cache);
  if (options.verify) verify_plan(plan, options.config.threads);
  return plan;
}

/// What only serves the next runs must not fail this one.
void or_say(const std::function<void()>& action) {
  try {
    action();
  } catch (const io::Error& e) {
    std::fprintf(stderr, "semigeo: %s\n", e.what());
  }
}

/// The next run need not read what this one read or made, and knows better what jobs need.
void learn(const RunOptions& options, const std::vector<PlannedJob>& plan,
           const std::vector<JobOutcome>& outcomes, DigestCache& cache) {
  for (std::size_t i = 0; i < plan.size(); ++i)
    if (outcomes[i].state == JobState::kDone) cache.dataset_keys(plan[i].job.name);
  or_say([&] { cache.write(); });
  const fs::path& archive = options.config.archive;
  if (std::ranges::count(outcomes, JobState::kDone, &JobOutcome::state) == 0) return;
  or_say([&] { learn_estimates(archive).write(archive); });
}

int dry_run(const RunOptions& options, const std::vector<FoundScan>& scans) {
  DigestCache cache(options.config.archive);
  const std::vector<PlannedJob> plan = make_plan(options, scans, cache);
  if (!options.dag.empty()) {
    const std::vector<GraphNode> graph = graph_of(plan);
    std::fputs((options.dag == "dot" ? to_dot(graph) : to_json(graph)).c_str(), stdout);
  } else {
    print_plan(plan, options.json, options.explain);
  }
  return std::ranges::all_of(plan, is_readable) ? kAllDone : kSomeFailed;
}

std::uintmax_t total_bytes(const std::vector<PlannedJob>& plan) {
  std::uintmax_t bytes = 0;
  for (const PlannedJob& planned : plan) bytes += bytes_to_read(planned);
  return bytes;
}

/// Here, or where `options` says. `stages` are what was left to Slurm.
std::vector<JobOutcome> execute(const RunOptions& options, const std::vector<PlannedJob>& plan,
                                Progress& progress, RunJournal* journal,
                                std::vector<SubmittedStage>& stages) {
  ExecutorOptions executor = options.executor;
  executor.program = fs::read_symlink("/proc/self/exe");
  executor.logs = options.config.archive / "logs";
  executor.threads = options.config.threads;
  executor.estimates = Estimates::read(options.config.archive);
  if (options.where == "local")
    return run_jobs(plan, options.config.surface, executor, progress, journal);
  SlurmOutcome outcome = run_on_slurm(plan, options.config.surface, options.config.archive,
                                      executor, options.slurm, progress, journal);
  stages = std::move(outcome.stages);
  return std::move(outcome.jobs);
}

/// Runs what is not up to date, and tells `journal`, if there is one.
std::vector<JobOutcome> run_plan(const RunOptions& options, const std::vector<PlannedJob>& plan,
                                 RunJournal* journal, RunSummary& summary,
                                 std::vector<SubmittedStage>& stages) {
  std::vector<JobOutcome> outcomes(plan.size());
  if (summary.up_to_date == std::ssize(plan)) {
    for (JobOutcome& outcome : outcomes) outcome.state = JobState::kUpToDate;
    return outcomes;
  }
  Progress progress(std::ssize(plan) - summary.up_to_date, total_bytes(plan));
  outcomes = execute(options, plan, progress, journal, stages);
  summary.vertex_levels = progress.vertex_levels();
  summary.done = std::ranges::count(outcomes, JobState::kDone, &JobOutcome::state);
  summary.failed = std::ranges::count(outcomes, JobState::kFailed, &JobOutcome::state);
  summary.not_run = std::ranges::count(outcomes, JobState::kNotRun, &JobOutcome::state);
  for (const JobOutcome& outcome : outcomes) {
    summary.cpu_seconds += outcome.cpu_seconds;
    summary.peak_bytes = std::max(summary.peak_bytes, outcome.peak_bytes);
  }
  return outcomes;
}

int run(const RunOptions& options, const std::vector<FoundScan>& scans,
        const std::string& effective_config) {
  const auto start = std::chrono::steady_clock::now();
  const Possession possession(options.config.archive);
  DigestCache cache(options.config.archive);
  const std::vector<PlannedJob> plan = make_plan(options, scans, cache);
  RunSummary summary;
  summary.up_to_date = std::ranges::count_if(plan, &PlannedJob::up_to_date);
  std::optional<RunJournal> journal;
  if (possession.lock) {
    prepare_archive(options.config.archive, effective_config, plan);
    or_say([&] { cache.write(); });  // so that a run that is killed has not hashed for nothing
    journal.emplace(options.config.archive,
                    RunStarted{.version = SEMIGEO_VERSION,
                               .threads = options.config.threads,
                               .jobs = std::ssize(plan) - summary.up_to_date,
                               .up_to_date = summary.up_to_date,
                               .input_bytes = static_cast<std::int64_t>(total_bytes(plan))});
  } else if (summary.up_to_date < std::ssize(plan)) {
    std::rethrow_exception(possession.unwritable);
  }
  if (options.explain && !options.json) {
    print_plan(plan, false, true);
    std::fflush(stdout);  // it is to be read while the jobs run
  }
  std::vector<SubmittedStage> stages;
  const auto outcomes = run_plan(options, plan, journal ? &*journal : nullptr, summary, stages);
  summary.wall_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  // Workers of a run that was killed may have lived a moment into this one.
  if (possession.lock) io::remove_stale_partials(options.config.archive / "scans");
  if (possession.lock && options.slurm.wait) remove_empty_logs(options.config.archive / "logs");
  const ProcessUsage usage = process_usage();
  summary.cpu_seconds += usage.cpu_seconds;
  summary.peak_bytes = std::max(summary.peak_bytes, usage.peak_bytes);
  if (journal) {
    journal->run_ended({.done = summary.done,
                        .up_to_date = summary.up_to_date,
                        .failed = summary.failed,
                        .seconds = summary.wall_seconds,
                        .cpu_seconds = summary.cpu_seconds});
    if (!journal->problem().empty())
      std::fprintf(stderr, "semigeo: %s\n", journal->problem().c_str());
    learn(options, plan, outcomes, cache);
  }
  if (!options.slurm.wait && !stages.empty()) {
    print_submitted(stages, options.json);
    return summary.failed == 0 ? kAllDone : kSomeFailed;
  }
  if (options.json) {
    print_json(plan, outcomes, options.config.surface, summary);
  } else {
    print_text(plan, outcomes, summary);
  }
  if (summary.not_run > 0) return kStoppedEarly;
  return summary.failed == 0 ? kAllDone : kSomeFailed;
}

int find_and_run(const RunOptions& options, const std::string& effective_config) {
  std::vector<FoundScan> scans;
  try {
    scans = find_scans(options.config.inputs, options.config.archive);
  } catch (const io::Error& e) {
    std::fprintf(stderr, "semigeo: %s\n", e.what());
    return kUsage;
  }
  if (scans.empty()) {
    std::fprintf(stderr, "semigeo: no .ply, .obj, .off or .stl file (or .gz of one) was found\n");
    return kUsage;
  }
  try {
    const bool dry = options.dry_run || !options.dag.empty();
    return dry ? dry_run(options, scans) : run(options, scans, effective_config);
  } catch (const LockedError& e) {
    std::fprintf(stderr, "semigeo: %s\n", e.what());
    return kLocked;
  }
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
      "  semigeo run scans/ --output archive --executor slurm --slurm-option partition=long\n"
      "  semigeo run scans/ --output archive --executor slurm --no-wait   run again to see the "
      "rest\n"
      "\n"
      "What is up to date, by content, is left alone; a run that was interrupted goes on where it\n"
      "stopped. Options may also come from --config FILE. Exit codes: 0 all done, 1 some scans "
      "failed,\n"
      "2 usage, 73 another run has the archive, 75 stopped early: run again to go on. The first\n"
      "Ctrl-C lets the running jobs end, the second ends them.\n");
  add_run_options(command, *options);
  command->fallthrough();
  command->callback([options, &exit_code] {
    apply_words(*options);
    exit_code = find_and_run(*options, config_text(*options));
  });
}

}  // namespace semigeo::jobs::cli
