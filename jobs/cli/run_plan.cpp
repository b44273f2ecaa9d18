#include "jobs/cli/run_plan.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <iterator>
#include <optional>
#include <set>
#include <string>

#include "io/files/atomic_file.hpp"
#include "io/files/error.hpp"
#include "jobs/archive/archive_lock.hpp"
#include "jobs/archive/estimates.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/run_report.hpp"
#include "jobs/plan/library_plan.hpp"
#include "jobs/plan/plan_graph.hpp"
#include "jobs/run/local_executor.hpp"
#include "jobs/run/process_usage.hpp"
#include "jobs/run/run_journal.hpp"

namespace semigeo::jobs::cli {
namespace {

namespace fs = std::filesystem;

/// The archive, made if need be, for this run alone. Throws LockedError if another run has it. If
/// it cannot be written there is no lock but a reason: where nothing is to be made that is fine.
struct Possession {
  std::optional<ArchiveLock> lock;
  std::exception_ptr unwritable;

  Possession(const fs::path& archive, bool is_kept) {
    if (!is_kept) return;
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

/// What only serves the next runs must not fail this one.
void or_say(const std::function<void()>& action) {
  try {
    action();
  } catch (const io::Error& e) {
    std::fprintf(stderr, "semigeo: %s\n", e.what());
  }
}

/// The next run need not read what this one read or made, and knows better what jobs need.
void learn(const fs::path& archive, const std::vector<PlannedJob>& plan,
           const std::vector<JobOutcome>& outcomes, DigestCache& cache) {
  bool learned = false;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    if (plan[i].job.kind != JobKind::kSurface || outcomes[i].state != JobState::kDone) continue;
    cache.dataset_keys(plan[i].job.name);
    learned = true;
  }
  or_say([&] { cache.write(); });
  if (learned) or_say([&] { learn_estimates(archive).write(archive); });
}

int dry_run(const ExecutionOptions& options, const RunConfig& config, const PlanSource& source) {
  DigestCache cache(config.archive);
  const std::vector<PlannedJob> plan = source.plan(cache);
  if (options.graph != GraphFormat::kNone) {
    const std::vector<GraphNode> graph = graph_of(plan);
    std::fputs((options.graph == GraphFormat::kDot ? to_dot(graph) : to_json(graph)).c_str(),
               stdout);
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
std::vector<JobOutcome> execute(const ExecutionOptions& options, const RunConfig& config,
                                const std::vector<PlannedJob>& plan, Progress& progress,
                                RunJournal* journal, std::vector<SubmittedStage>& stages) {
  ExecutorOptions executor = options.limits;
  executor.program = fs::read_symlink("/proc/self/exe");
  executor.logs = config.archive / "logs";
  executor.estimates = Estimates::read(config.archive);
  if (options.executor == ExecutorKind::kLocal)
    return run_jobs(plan, config.jobs, executor, progress, journal);
  SlurmOutcome outcome =
      run_on_slurm(plan, config.jobs, config.archive, executor, options.slurm, progress, journal);
  stages = std::move(outcome.stages);
  return std::move(outcome.jobs);
}

/// Runs what is not up to date, and tells `journal`, if there is one.
std::vector<JobOutcome> run_jobs_of(const ExecutionOptions& options, const RunConfig& config,
                                    const std::vector<PlannedJob>& plan, RunJournal* journal,
                                    RunSummary& summary, std::vector<SubmittedStage>& stages) {
  std::vector<JobOutcome> outcomes(plan.size());
  if (summary.up_to_date == std::ssize(plan)) {
    for (JobOutcome& outcome : outcomes) outcome.state = JobState::kUpToDate;
    return outcomes;
  }
  Progress progress(std::ssize(plan) - summary.up_to_date, total_bytes(plan));
  outcomes = execute(options, config, plan, progress, journal, stages);
  summary.vertex_levels = progress.vertex_levels();
  const auto count = [&](JobState state) {
    return std::ranges::count(outcomes, state, &JobOutcome::state);
  };
  summary.done = count(JobState::kDone);
  summary.up_to_date = count(JobState::kUpToDate);
  summary.failed = count(JobState::kFailed);
  summary.skipped = count(JobState::kSkipped);
  summary.not_run = count(JobState::kNotRun);
  for (const JobOutcome& outcome : outcomes) {
    summary.cpu_seconds += outcome.cpu_seconds;
    summary.peak_bytes = std::max(summary.peak_bytes, outcome.peak_bytes);
  }
  return outcomes;
}

/// What workers of a run that was killed have left, who may have lived a moment into this one; and
/// what a library is not made of any more.
void clean_up(const ExecutionOptions& options, const RunConfig& config,
              const std::vector<PlannedJob>& plan, const std::vector<JobOutcome>& outcomes) {
  std::set<fs::path> folders;
  for (const PlannedJob& planned : plan) folders.insert(planned.job.output.parent_path());
  for (const fs::path& folder : folders) io::remove_stale_partials(folder);
  if (!options.slurm.wait) return;
  remove_empty_logs(config.archive / "logs");
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const JobState state = outcomes[i].state;
    if (plan[i].job.kind == JobKind::kLibrary &&
        (state == JobState::kDone || state == JobState::kUpToDate))
      remove_spare_parts(plan[i].job);
  }
}

int print_results(const ExecutionOptions& options, const RunConfig& config,
                  const PlanSource& source, const std::vector<PlannedJob>& plan,
                  const std::vector<JobOutcome>& outcomes, const RunSummary& summary) {
  if (source.print) {
    source.print(plan, outcomes, summary);
  } else if (options.json) {
    print_json(plan, outcomes, config.jobs.surface, summary);
  } else {
    print_text(plan, outcomes, summary);
  }
  if (summary.not_run > 0) return kStoppedEarly;
  return summary.failed == 0 ? kAllDone : kSomeFailed;
}

std::optional<RunJournal> begin(const RunConfig& config, const PlanSource& source,
                                const std::vector<PlannedJob>& plan, const RunSummary& summary,
                                DigestCache& cache) {
  io::remove_stale_partials(config.archive);
  if (source.prepare) source.prepare(plan);
  remove_damaged_parts(plan);
  // So that a run that is killed has not hashed for nothing.
  if (source.is_archive) or_say([&] { cache.write(); });
  return std::make_optional<RunJournal>(
      config.archive, RunStarted{.version = SEMIGEO_VERSION,
                                 .threads = config.threads,
                                 .jobs = std::ssize(plan) - summary.up_to_date,
                                 .up_to_date = summary.up_to_date,
                                 .input_bytes = static_cast<std::int64_t>(total_bytes(plan))});
}

void end(RunJournal& journal, const RunSummary& summary) {
  journal.run_ended({.done = summary.done,
                     .up_to_date = summary.up_to_date,
                     .failed = summary.failed,
                     .seconds = summary.wall_seconds,
                     .cpu_seconds = summary.cpu_seconds});
  if (!journal.problem().empty()) std::fprintf(stderr, "semigeo: %s\n", journal.problem().c_str());
}

int run(const ExecutionOptions& options, const RunConfig& config, const PlanSource& source) {
  const auto start = std::chrono::steady_clock::now();
  const fs::path& archive = config.archive;
  const Possession possession(archive, source.is_kept);
  // What is to be verified is not taken from memory.
  DigestCache cache = options.verify ? DigestCache(archive) : DigestCache::read(archive);
  const std::vector<PlannedJob> plan = source.plan(cache);
  RunSummary summary;
  summary.up_to_date = std::ranges::count_if(plan, &PlannedJob::up_to_date);
  std::optional<RunJournal> journal;
  if (possession.lock) {
    journal = begin(config, source, plan, summary, cache);
  } else if (source.is_kept && summary.up_to_date < std::ssize(plan)) {
    std::rethrow_exception(possession.unwritable);
  }
  if (options.explain && !options.json) {
    print_plan(plan, false, true);
    std::fflush(stdout);  // it is to be read while the jobs run
  }
  std::vector<SubmittedStage> stages;
  const auto outcomes =
      run_jobs_of(options, config, plan, journal ? &*journal : nullptr, summary, stages);
  summary.wall_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (possession.lock) clean_up(options, config, plan, outcomes);
  const ProcessUsage usage = process_usage();
  summary.cpu_seconds += usage.cpu_seconds;
  summary.peak_bytes = std::max(summary.peak_bytes, usage.peak_bytes);
  if (journal) {
    end(*journal, summary);
    if (source.is_archive) learn(archive, plan, outcomes, cache);
  }
  if (!options.slurm.wait && !stages.empty()) {
    print_submitted(stages, options.json);
    return summary.failed == 0 ? kAllDone : kSomeFailed;
  }
  return print_results(options, config, source, plan, outcomes, summary);
}

}  // namespace

int run_plan(const ExecutionOptions& options, const RunConfig& config, const PlanSource& source) {
  try {
    const bool dry = options.dry_run || options.graph != GraphFormat::kNone;
    return dry ? dry_run(options, config, source) : run(options, config, source);
  } catch (const LockedError& e) {
    std::fprintf(stderr, "semigeo: %s\n", e.what());
    return kLocked;
  }
}

}  // namespace semigeo::jobs::cli
