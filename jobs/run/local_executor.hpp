#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "jobs/archive/estimates.hpp"
#include "jobs/plan/plan.hpp"
#include "jobs/run/job_result.hpp"
#include "jobs/run/progress.hpp"

namespace semigeo::jobs {

enum class JobState {
  kDone,
  kUpToDate,
  kFailed,
  kSkipped,  ///< what it needs is not there, as a job before it has failed
  kNotRun    ///< the run stopped before
};

/// "done", "up to date", "failed", "skipped" or "not run".
std::string_view name_of(JobState state);

struct JobOutcome {
  JobState state = JobState::kNotRun;
  std::string error;  ///< of a failed or skipped job: one sentence, and its last lines
  JobResult result;   ///< of a job that is done
  double seconds = 0;
  double cpu_seconds = 0;
  double peak_bytes = 0;
  int threads = 0;
  int attempts = 0;
};

/// What the jobs of a run may take; 0 = by themselves.
struct ExecutorOptions {
  std::filesystem::path program;     ///< of which `PROGRAM job` is a worker
  std::filesystem::path logs;        ///< folder for what jobs print
  int threads = 0;                   ///< at once, of all jobs; 0: one per core
  std::uint64_t memory_bytes = 0;    ///< of all jobs that run side by side; 0: what is free
  std::uint64_t memory_per_job = 0;  ///< address space of one; 0: several times the estimate
  double timeout_seconds = 0;        ///< of one, by the clock; 0: many times the estimate
  int retries = 1;                   ///< of a job that a signal or a limit ended
  bool fail_fast = false;            ///< start nothing after the first failure
  Estimates estimates = {};          ///< of what jobs need
  double most_seconds = 0;           ///< start nothing that is not expected to end in time; 0: any
  /// Takes what no job has printed. Empty: workers.log in `logs`, which then is ours: when the jobs
  /// have ended, empty logs are removed. Otherwise others may just have opened theirs in it.
  std::filesystem::path worker_log = {};
};

/// Whether nothing more will become of the job: what waits for it need not wait.
constexpr bool has_ended(JobState state) {
  return state != JobState::kNotRun;
}

/// Is told of each job that runs, in the thread that called run_jobs.
class JobListener {
 public:
  virtual ~JobListener() = default;
  virtual void job_started(const PlannedJob& planned) = 0;
  /// Also of a job that was skipped, or turned out to be up to date: those were never started.
  virtual void job_ended(const PlannedJob& planned, const JobOutcome& outcome) = 0;
};

/// By what the time that a job takes is judged: the size of its scan, 0 if it reads none.
std::uintmax_t bytes_to_read(const PlannedJob& planned);

/// Takes what the job prints.
std::filesystem::path log_path(const std::filesystem::path& logs, const Job& job);

/// Those that jobs had opened when they were killed. Nobody must be writing into that folder.
void remove_empty_logs(const std::filesystem::path& folder);

/// Runs the jobs that are not up to date in child processes, which do one job after the other: as
/// many side by side as cores and memory admit, the longest first; one that takes more than its
/// share of what is left gets more threads. A job begins when those before it have ended, well or
/// not, and takes what they have left (JobInputs); one that finds nothing to begin with is skipped
/// if one before it has failed. Whatever a job does to its process - a crash, an
/// endless loop, a memory bomb - is one failed job. The first SIGINT or SIGTERM lets the running
/// jobs end and starts no more, the second ends them. outcomes[i] belongs to plan[i].
std::vector<JobOutcome> run_jobs(const std::vector<PlannedJob>& plan,
                                 const JobParameters& parameters, const ExecutorOptions& options,
                                 Progress& progress, JobListener* listener = nullptr);

}  // namespace semigeo::jobs
