#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <string>

#include "io/atomic_file.hpp"
#include "io/error.hpp"
#include "jobs/archive_lock.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/run_options.hpp"
#include "jobs/cli/run_report.hpp"
#include "jobs/journal.hpp"
#include "jobs/local_executor.hpp"
#include "jobs/process_identity.hpp"
#include "jobs/utc_time.hpp"

namespace semigeo::jobs::cli {
namespace {

namespace fs = std::filesystem;

/// What this process has taken of the machine, the jobs' own processes apart.
void add_own_costs(RunSummary& summary) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  summary.cpu_seconds += seconds(usage.ru_utime) + seconds(usage.ru_stime);
  summary.peak_bytes = std::max(summary.peak_bytes, 1024.0 * static_cast<double>(usage.ru_maxrss));
}

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

/// For the next run: it need not read what this one read or made.
void remember_datasets(const std::vector<PlannedJob>& plan, const std::vector<JobOutcome>& outcomes,
                       DigestCache& cache) {
  for (std::size_t i = 0; i < plan.size(); ++i)
    if (outcomes[i].state == JobState::kDone) cache.dataset_keys(plan[i].job.name);
  try {
    cache.write();
  } catch (const io::Error& e) {
    std::fprintf(stderr, "semigeo: %s\n", e.what());  // only the next run's planning suffers
  }
}

int dry_run(const RunOptions& options, const std::vector<FoundScan>& scans) {
  DigestCache cache(options.config.archive);
  const std::vector<PlannedJob> plan = make_plan(options, scans, cache);
  print_plan(plan, options.json);
  return std::ranges::all_of(plan, is_readable) ? kAllDone : kSomeFailed;
}

/// A name for this run that no other run of the archive has.
std::string run_name() {
  return utc_time() + "-" + std::to_string(getpid());
}

/// Keeps the journal of a run, if the archive lets it: nothing but estimates depends on it.
class RunJournal {
 public:
  explicit RunJournal(const fs::path& archive) {
    try {
      journal_.emplace(archive, run_name());
    } catch (const io::Error& e) {
      warn(e);
    }
  }
  Journal* get() { return journal_ ? &*journal_ : nullptr; }
  void write(const JournalEvent& event) {
    if (!journal_) return;
    try {
      journal_->write(event);
    } catch (const io::Error& e) {
      warn(e);
      journal_.reset();
    }
  }

 private:
  static void warn(const io::Error& e) { std::fprintf(stderr, "semigeo: %s\n", e.what()); }
  std::optional<Journal> journal_;
};

/// Does what is not up to date.
std::vector<JobOutcome> execute(const RunOptions& options, const std::vector<PlannedJob>& plan,
                                RunSummary& summary) {
  const auto to_run = std::ranges::count(plan, false, &PlannedJob::up_to_date);
  if (to_run == 0) {
    JobOutcome up_to_date;
    up_to_date.state = JobState::kUpToDate;
    return std::vector<JobOutcome>(plan.size(), up_to_date);
  }
  std::uintmax_t bytes = 0;
  for (const PlannedJob& p : plan) bytes += bytes_to_read(p);
  const fs::path& archive = options.config.archive;
  ExecutorOptions executor = options.executor;
  executor.program = fs::read_symlink("/proc/self/exe");
  executor.logs = archive / "logs";
  executor.threads = options.config.threads;
  RunJournal journal(archive);
  const auto start = std::chrono::steady_clock::now();
  journal.write(RunStarted{.version = SEMIGEO_VERSION,
                           .host = this_process().host,
                           .pid = getpid(),
                           .threads = options.config.threads,
                           .jobs = to_run,
                           .up_to_date = std::ssize(plan) - to_run});
  Progress progress(to_run, bytes);
  std::vector<JobOutcome> outcomes =
      run_jobs(plan, options.config.surface, executor, journal.get(), progress);
  summary.vertex_levels = progress.vertex_levels();
  RunEnded ended;
  for (const JobOutcome& outcome : outcomes) {
    ended.done += outcome.state == JobState::kDone;
    ended.up_to_date += outcome.state == JobState::kUpToDate;
    ended.failed += outcome.state == JobState::kFailed;
    ended.cpu_seconds += outcome.cpu_seconds;
  }
  ended.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  journal.write(ended);
  return outcomes;
}

int run(const RunOptions& options, const std::vector<FoundScan>& scans,
        const std::string& effective_config) {
  const auto start = std::chrono::steady_clock::now();
  const Possession possession(options.config.archive);
  DigestCache cache(options.config.archive);
  const std::vector<PlannedJob> plan = make_plan(options, scans, cache);
  if (possession.lock) {
    prepare_archive(options.config.archive, effective_config, plan);
  } else if (!std::ranges::all_of(plan, &PlannedJob::up_to_date)) {
    std::rethrow_exception(possession.unwritable);
  }
  RunSummary summary;
  const std::vector<JobOutcome> outcomes = execute(options, plan, summary);
  if (possession.lock) {
    // Workers of a run that was killed may have lived a moment into this one.
    io::remove_stale_partials(options.config.archive / "scans");
    remember_datasets(plan, outcomes, cache);
  }
  for (const JobOutcome& outcome : outcomes) {
    summary.done += outcome.state == JobState::kDone;
    summary.up_to_date += outcome.state == JobState::kUpToDate;
    summary.failed += outcome.state == JobState::kFailed;
    summary.not_run += outcome.state == JobState::kNotRun;
    summary.cpu_seconds += outcome.cpu_seconds;
    summary.peak_bytes = std::max(summary.peak_bytes, outcome.peak_bytes);
  }
  summary.wall_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  add_own_costs(summary);
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
    return options.dry_run ? dry_run(options, scans) : run(options, scans, effective_config);
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
      "  semigeo run scans/ --output archive --verify    also what the disk has damaged since\n"
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
