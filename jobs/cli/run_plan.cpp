#include "jobs/cli/run_plan.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "io/files/write_error.hpp"
#include "jobs/archive/archive_lock.hpp"
#include "jobs/archive/estimates.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/failures.hpp"
#include "jobs/cli/output.hpp"
#include "jobs/cli/run_report.hpp"
#include "jobs/plan/plan_graph.hpp"
#include "jobs/run/drain.hpp"
#include "jobs/run/local_runner.hpp"
#include "jobs/slurm/slurm_runner.hpp"

namespace semigeo::jobs::cli {
namespace {

namespace fs = std::filesystem;

int dry_run(const ExecutionOptions& options, const PlanSource& source) {
  DigestCache cache(source.home);
  const std::vector<PlannedJob> plan = source.plan(cache);
  if (options.graph == GraphFormat::kDot) {
    write_graph_dot(plan, print_text);
  } else if (options.graph == GraphFormat::kJson) {
    write_graph_json(plan, print_text);
  } else {
    print_plan(plan, options.json, options.explain, source.notes());
  }
  return std::ranges::all_of(plan, is_readable) ? kAllDone : kSomeFailed;
}

/// Makes the runner that the options ask for.
class ChosenRunner {
 public:
  ChosenRunner(const ExecutionOptions& options, const fs::path& home)
      : options_(options), home_(home), executor_(options.limits) {
    executor_.program = fs::read_symlink("/proc/self/exe");
    executor_.logs = home / "logs";
  }

  ExecutionSettings execution() {
    executor_.estimates = Estimates::read(home_);
    return execution_settings(executor_);
  }

  Runner& runner(const std::vector<PlannedJob>& plan) {
    if (options_.executor == ExecutorKind::kSlurm) {
      slurm_ = std::make_unique<SlurmRunner>(plan, home_, executor_, options_.slurm);
      return *slurm_;
    }
    prepare_folders(plan, executor_);
    local_ = std::make_unique<LocalRunner>(executor_);
    return *local_;
  }

  /// Returns the stages that were submitted to Slurm.
  std::vector<SubmittedStage> submitted() const {
    return slurm_ ? slurm_->submitted() : std::vector<SubmittedStage>();
  }

 private:
  const ExecutionOptions& options_;
  const fs::path& home_;
  ExecutorOptions executor_;
  std::unique_ptr<LocalRunner> local_;
  std::unique_ptr<SlurmRunner> slurm_;
};

/// Returns whether no output that was made lacks something that it was to have.
bool is_complete(const RunResult& result) {
  for (std::size_t i = 0; i < result.plan.size(); ++i) {
    const Job& job = result.plan[i].job;
    const auto told = job.kind->summary(job, result.outcomes[i].state);
    if (told && told->is_incomplete) return false;
  }
  return true;
}

/// Prints what a run has done. Returns its exit code.
int print_results(const ExecutionOptions& options, const PlanSource& source,
                  const RunResult& result, const std::vector<SubmittedStage>& submitted) {
  if (!options.slurm.wait && !submitted.empty()) {
    print_submitted(submitted, options.json);
    return result.summary.failed == 0 ? kAllDone : kSomeFailed;
  }
  if (source.print) {
    source.print(result);
  } else if (options.json) {
    print_json(result, source.notes());
  } else {
    RunNotes notes = source.notes();
    notes.failures_were_told = !options.quiet && outputs_are_one_place();
    notes.home = source.home;
    print_run(result, notes);
  }
  if (result.summary.not_run > 0) return kStoppedEarly;
  return result.summary.failed == 0 && is_complete(result) ? kAllDone : kSomeFailed;
}

/// Returns what was passed over as one text: the notes, and the files by their kinds.
std::string all_in_words(const PassedOver& passed_over) {
  std::string text = in_words(passed_over);
  for (const std::string& note : passed_over.notes) text += (text.empty() ? "" : "; ") + note;
  return text;
}

// The folder of a run that keeps nothing, for a signal handler.
std::string folder_to_remove;

/// Ends a run whose plan is being made: nothing was done yet. The signal handler calls it.
void end_at_once() {
  static constexpr std::string_view kSentence =
      "semigeo: stopped before a job began; run again to go on\n";
  remove_own_lock();
  if (!folder_to_remove.empty()) rmdir(folder_to_remove.c_str());
  [[maybe_unused]] const ssize_t told = write(STDERR_FILENO, kSentence.data(), kSentence.size());
  _exit(kStoppedEarly);
}

int run(const ExecutionOptions& options, const PlanSource& source) {
  folder_to_remove = source.is_kept ? "" : source.home.string();
  const EarlySignals signals;
  ChosenRunner chosen(options, source.home);
  RunHooks hooks{
      .plan =
          [&](DigestCache& cache) {
            const EndAtOnce scope(end_at_once);
            return source.plan(cache);
          },
      .prepare = source.prepare,
      .runner = [&](const std::vector<PlannedJob>& plan) -> Runner& { return chosen.runner(plan); },
      .settings = [&] { return chosen.execution(); },
      .warn = [](const std::string& what) { complain(what); }};
  if (options.explain && !options.json)
    hooks.planned = [](const std::vector<PlannedJob>& plan) {
      print_plan(plan, false, true);
      std::fflush(stdout);  // so that it can be read while the jobs run
    };
  int exit_code = kAllDone;
  hooks.ended = [&](const RunResult& result) {
    exit_code = print_results(options, source, result, chosen.submitted());
  };
  perform_run({.home = source.home,
               .program_version = SEMIGEO_VERSION,
               .threads = options.limits.threads,
               .verify = options.verify,
               .is_archive = source.is_archive,
               .is_kept = source.is_kept,
               .is_quiet = options.quiet,
               .passed_over = all_in_words(source.passed_over),
               .must_write = source.must_write},
              hooks);
  return exit_code;
}

}  // namespace

InterruptibleSearch::InterruptibleSearch() : end_(end_at_once) {}

int run_plan(const ExecutionOptions& options, const PlanSource& source) {
  try {
    const bool dry = options.dry_run || options.graph != GraphFormat::kNone;
    return dry ? dry_run(options, source) : run(options, source);
  } catch (const LockedError& e) {
    complain(e);
    return kLocked;
  } catch (const io::WriteError& e) {
    complain(e);
    return io::concerns_the_place(e.code()) ? kStoppedEarly : kSomeFailed;
  }
}

}  // namespace semigeo::jobs::cli
