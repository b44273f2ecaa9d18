#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "jobs/archive/digest_cache.hpp"
#include "jobs/run/execution.hpp"
#include "jobs/run/job_outcome.hpp"
#include "jobs/run/runner.hpp"

namespace semigeo::jobs {

/// Counts and costs of a run, for its last line.
struct RunSummary {
  std::int64_t done = 0;
  std::int64_t up_to_date = 0;
  std::int64_t failed = 0;
  std::int64_t skipped = 0;  ///< Jobs whose inputs are missing because others have failed.
  std::int64_t not_run = 0;
  std::int64_t vertex_levels = 0;
  double wall_seconds = 0;
  double cpu_seconds = 0;
  double peak_bytes = 0;
  /// Returns the vertices times levels per second.
  double rate() const {
    return wall_seconds > 0 ? static_cast<double>(vertex_levels) / wall_seconds : 0;
  }
};

/// The settings of a run.
struct RunSettings {
  /// Folder that has the lock, the journal, the logs and what was learned.
  std::filesystem::path home;
  std::string program_version;   ///< For the journal.
  int threads = 0;               ///< For the journal; 0: one per core.
  bool verify = false;           ///< Outputs are read instead of trusting the digest cache.
  bool is_archive = true;        ///< The home is an archive; rates of its jobs are learned.
  bool is_kept = true;           ///< The home is kept; otherwise it gets neither lock nor journal.
  bool is_quiet = false;         ///< No progress is printed.
  std::string passed_over = {};  ///< For the journal: files that are no scans, in words.
  bool must_write = false;       ///< A home that cannot be written is a failure in any case.
};

/// The plan of a run and what has become of its jobs.
struct RunResult {
  std::vector<PlannedJob> plan;
  std::vector<JobOutcome> outcomes;  ///< outcomes[i] belongs to plan[i].
  std::string stopped = {};  ///< Why outputs could not be written any more; empty if they could.
  RunSummary summary;
};

/// The functions that a run calls.
struct RunHooks {
  /// Makes the plan and writes nothing. It is called after the home was locked.
  std::function<std::vector<PlannedJob>(DigestCache&)> plan;
  /// Prepares the home before jobs run. It is called only if the home can be written.
  std::function<void(const std::vector<PlannedJob>&)> prepare = {};
  /// Receives the plan before jobs run.
  std::function<void(const std::vector<PlannedJob>&)> planned = {};
  /// Returns the runner of the jobs, which must live as long as the run.
  std::function<Runner&(const std::vector<PlannedJob>&)> runner;
  /// Returns the settings of the execution; called after the lock is taken, because the home may
  /// have learned until then.
  std::function<ExecutionSettings()> settings;
  /// Receives a sentence about each problem that does not make the run fail.
  std::function<void(const std::string&)> warn;
  /// Receives the result while the home is still locked, so that no other run replaces the outputs
  /// that are read for a report.
  std::function<void(const RunResult&)> ended = {};
};

/// Makes a plan and executes it: takes the lock of the home, plans, opens the journal, executes the
/// jobs, learns for the next run, and cleans up. Throws LockedError if another run has the home,
/// and io::Error if the home cannot be written although jobs have to run. If no job has to run, a
/// home that cannot be written is no failure.
RunResult perform_run(const RunSettings& settings, const RunHooks& hooks,
                      const RunClock& clock = steady_clock());

}  // namespace semigeo::jobs
