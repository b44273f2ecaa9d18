#pragma once

#include <any>
#include <string>

#include "jobs/plan/job_state.hpp"
#include "jobs/plan/plan.hpp"

namespace semigeo::jobs {

/// The outcome of one job of a run. Values that are not known are zero or empty.
struct JobOutcome {
  JobState state = JobState::kNotRun;
  std::string error = {};  ///< Why the job failed or was skipped: one sentence, and its last lines.
  std::any result = {};    ///< Result of a job that is done, in the type of its kind.
  double seconds = 0;
  double cpu_seconds = 0;
  double peak_bytes = 0;  ///< The most memory that was resident at once.
  int write_error = 0;    ///< The errno if the output could not be written; otherwise 0.
  int threads = 0;
  int attempts = 0;
};

/// A listener to the jobs of a run. It is called in the thread that executes the plan.
class JobListener {
 public:
  virtual ~JobListener() = default;
  /// Is called when the first attempt at a job starts.
  virtual void job_started(const PlannedJob& planned) = 0;
  /// Is called when a job has ended. That includes jobs that were never started, because they were
  /// skipped or turned out to be up to date.
  virtual void job_ended(const PlannedJob& planned, const JobOutcome& outcome) = 0;
};

}  // namespace semigeo::jobs
