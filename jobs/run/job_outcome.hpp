#pragma once

#include <any>
#include <string>

#include "jobs/plan/job_state.hpp"
#include "jobs/plan/plan.hpp"

namespace semigeo::jobs {

/// What has become of one job of a run. What is not known is zero or empty.
struct JobOutcome {
  JobState state = JobState::kNotRun;
  std::string error = {};  ///< Why the job failed or was skipped: one sentence, and its last lines.
  std::any result = {};    ///< What a job that is done tells, in the type of its kind.
  double seconds = 0;
  double cpu_seconds = 0;
  double peak_bytes = 0;  ///< The most memory that was resident at once.
  int threads = 0;
  int attempts = 0;
};

/// Is told of each job that runs, in the thread that executes the plan.
class JobListener {
 public:
  virtual ~JobListener() = default;
  virtual void job_started(const PlannedJob& planned) = 0;
  /// Is also called for jobs that were never started, because they were skipped or turned out to be
  /// up to date.
  virtual void job_ended(const PlannedJob& planned, const JobOutcome& outcome) = 0;
};

}  // namespace semigeo::jobs
