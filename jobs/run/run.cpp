#include "jobs/run/run.hpp"

#include <algorithm>
#include <exception>
#include <optional>
#include <set>
#include <utility>

#include "io/files/atomic_file.hpp"
#include "io/files/error.hpp"
#include "jobs/archive/archive_lock.hpp"
#include "jobs/archive/estimates.hpp"
#include "jobs/archive/links.hpp"
#include "jobs/plan/job_kind.hpp"
#include "jobs/run/job_logs.hpp"
#include "jobs/run/process_usage.hpp"
#include "jobs/run/run_journal.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

std::int64_t bytes_to_read(const std::vector<PlannedJob>& plan) {
  std::uintmax_t bytes = 0;
  for (const PlannedJob& planned : plan) bytes += jobs::bytes_to_read(planned);
  return static_cast<std::int64_t>(bytes);
}

class Run {
 public:
  Run(const RunSettings& settings, const RunHooks& hooks, const RunClock& clock)
      : settings_(settings), hooks_(hooks), clock_(clock), cache_(settings.home) {}

  RunResult perform() {
    take_lock();
    make_plan();
    begin_journal();
    if (hooks_.planned) hooks_.planned(result_.plan);
    execute_plan();
    result_.summary.wall_seconds = clock_();
    clean_up();
    count_own_usage();
    end_journal();
    learn();
    if (hooks_.ended) hooks_.ended(result_);
    return std::move(result_);
  }

 private:
  /// Takes the lock of the home. If the home cannot be written there is no lock, but a reason that
  /// counts only if a job has to run.
  void take_lock() {
    if (!settings_.is_kept) return;
    try {
      std::error_code error;
      fs::create_directories(settings_.home, error);
      if (error)
        throw io::Error(settings_.home, "", "cannot be created: " + error.message(),
                        "check --output, its permissions and the free space");
      lock_.emplace(settings_.home);
    } catch (const LockedError&) {
      throw;
    } catch (const io::Error&) {
      unwritable_ = std::current_exception();
    }
  }

  void make_plan() {
    if (!settings_.verify) cache_ = DigestCache::read(settings_.home);
    result_.plan = hooks_.plan(cache_);
    result_.summary.up_to_date = std::ranges::count_if(result_.plan, &PlannedJob::up_to_date);
    if (unwritable_ && (jobs_to_run() > 0 || settings_.must_write))
      std::rethrow_exception(unwritable_);
  }

  std::int64_t jobs_to_run() const { return std::ssize(result_.plan) - result_.summary.up_to_date; }

  void begin_journal() {
    if (!lock_) return;
    refuse_links(settings_.home);
    io::remove_stale_partials(settings_.home);
    if (hooks_.prepare) hooks_.prepare(result_.plan);
    remove_damaged_outputs(result_.plan);
    // Digests are saved now, so that they are not lost if the run is killed.
    if (settings_.is_archive) try_to([&] { cache_.write(); });
    const std::vector<const PlannedJob*> recovered = recovered_jobs();
    const std::int64_t told = std::ssize(recovered);
    journal_.emplace(settings_.home, RunStarted{.version = settings_.program_version,
                                                .threads = settings_.threads,
                                                .jobs = jobs_to_run() + told,
                                                .up_to_date = result_.summary.up_to_date - told,
                                                .input_bytes = bytes_to_read(result_.plan),
                                                .passed_over = settings_.passed_over});
    for (const PlannedJob* planned : recovered)
      journal_->job_ended(*planned, {.state = JobState::kUpToDate});
  }

  /// Returns the jobs that are up to date and have failed in an earlier run: their scan could not
  /// be read then, for example. The journal is told, or it would call them failed for ever.
  std::vector<const PlannedJob*> recovered_jobs() const {
    std::vector<const PlannedJob*> recovered;
    if (result_.summary.up_to_date == 0) return recovered;
    const std::set<std::string> failed = failed_jobs(settings_.home);
    for (const PlannedJob& planned : result_.plan)
      if (planned.up_to_date && failed.contains(job_id(planned.job))) recovered.push_back(&planned);
    return recovered;
  }

  void execute_plan() {
    std::vector<JobOutcome>& outcomes = result_.outcomes;
    RunSummary& summary = result_.summary;
    if (jobs_to_run() == 0) {
      outcomes.assign(result_.plan.size(), {.state = JobState::kUpToDate});
      return;
    }
    Progress progress(jobs_to_run(), static_cast<std::uintmax_t>(bytes_to_read(result_.plan)),
                      settings_.is_quiet);
    Runner& runner = hooks_.runner(result_.plan);
    outcomes = execute(result_.plan, runner, hooks_.settings(), progress,
                       journal_ ? &*journal_ : nullptr, clock_);
    waited_ = runner.waits();
    summary.vertex_levels = progress.vertex_levels();
    const auto refused = std::ranges::find_if(outcomes, [](const JobOutcome& outcome) {
      return outcome.state == JobState::kNotRun && outcome.write_error != 0 &&
             !outcome.error.empty();
    });
    if (refused != outcomes.end()) result_.stopped = refused->error;
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
  }

  /// Removes partial files of the workers of a killed run, which may have lived until after the
  /// start of this one, and files that finished outputs no longer need.
  void clean_up() {
    if (!lock_) return;
    std::set<fs::path> folders;
    for (const PlannedJob& planned : result_.plan) folders.insert(planned.job.output.parent_path());
    for (const fs::path& folder : folders) io::remove_stale_partials(folder);
    if (!waited_) return;
    remove_empty_logs(settings_.home / "logs");
    for (std::size_t i = 0; i < result_.plan.size(); ++i)
      if (is_made(result_.outcomes[i].state))
        result_.plan[i].job.kind->clean_up(result_.plan[i].job);
  }

  void count_own_usage() {
    const ProcessUsage usage = process_usage();
    result_.summary.cpu_seconds += usage.cpu_seconds;
    result_.summary.peak_bytes = std::max(result_.summary.peak_bytes, usage.peak_bytes);
  }

  void end_journal() {
    if (!journal_) return;
    const RunSummary& summary = result_.summary;
    journal_->run_ended({.done = summary.done,
                         .up_to_date = summary.up_to_date,
                         .failed = summary.failed,
                         .seconds = summary.wall_seconds,
                         .cpu_seconds = summary.cpu_seconds});
    if (!journal_->problem().empty()) warn(journal_->problem());
  }

  /// Saves the digests of the outputs and the learned rates for the next run.
  void learn() {
    if (!journal_ || !settings_.is_archive) return;
    bool learned = false;
    for (std::size_t i = 0; i < result_.plan.size(); ++i) {
      const Job& job = result_.plan[i].job;
      if (result_.outcomes[i].state == JobState::kDone) learned |= job.kind->remember(job, cache_);
    }
    try_to([&] { cache_.write(); });
    if (learned) try_to([&] { learn_estimates(settings_.home).write(settings_.home); });
  }

  /// Only warns if the action fails, because it only serves the next runs.
  void try_to(const std::function<void()>& action) {
    try {
      action();
    } catch (const io::Error& e) {
      warn(e.what());
    }
  }

  /// Warns of a problem, unless it is known already that nothing can be written.
  void warn(const std::string& problem) {
    if (result_.stopped.empty()) hooks_.warn(problem);
  }

  const RunSettings& settings_;
  const RunHooks& hooks_;
  const RunClock& clock_;
  DigestCache cache_;
  std::optional<ArchiveLock> lock_;
  std::exception_ptr unwritable_;
  std::optional<RunJournal> journal_;
  bool waited_ = true;  ///< The runner has waited for its jobs.
  RunResult result_;
};

}  // namespace

RunResult perform_run(const RunSettings& settings, const RunHooks& hooks, const RunClock& clock) {
  return Run(settings, hooks, clock).perform();
}

}  // namespace semigeo::jobs
