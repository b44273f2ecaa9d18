#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "jobs/archive/estimates.hpp"
#include "jobs/run/job_outcome.hpp"
#include "jobs/run/progress.hpp"
#include "jobs/run/runner.hpp"

namespace semigeo::jobs {

/// The settings of all jobs of an execution, wherever they run.
struct ExecutionSettings {
  engine::Amount total = {};       ///< Cores and bytes of all jobs that run side by side.
  std::uint64_t memory_bytes = 0;  ///< The limit that the user gave, in bytes; 0: none.
  double most_seconds = 0;         ///< Nothing starts that would not end in time; 0: no limit.
  int retries = 1;                 ///< Further attempts at a job whose process was lost.
  bool fail_fast = false;          ///< Nothing starts after the first failure.
  Estimates estimates = {};        ///< What is known about scans.
};

/// Returns the seconds since the execution began.
using RunClock = std::function<double()>;
/// Returns a clock that measures real time.
RunClock steady_clock();

/// Returns what each job of a plan is expected to need on one thread. Jobs that do not run need
/// nothing.
std::vector<Estimate> estimates_of(const std::vector<PlannedJob>& plan, const Estimates& learned,
                                   std::uint64_t memory_bytes);

/// Runs the jobs of a plan that are not up to date, in the order that Scheduler decides. A job
/// begins when those before it have ended, whether done or failed, and takes the outputs that exist
/// (JobKind::resolve_inputs). A job without inputs is skipped if a job before it has failed. A job
/// whose process was lost is tried again, `retries` times. The first signal lets the running jobs
/// end and starts no more; the second ends them. If the place of the outputs cannot be written any
/// more (io::concerns_the_place), the running jobs may end and no more starts; the jobs that met
/// the error have not run, and the outcome of the first says why. outcomes[i] belongs to plan[i].
/// Throws what the runner throws.
std::vector<JobOutcome> execute(std::vector<PlannedJob> plan, Runner& runner,
                                const ExecutionSettings& settings, Progress& progress,
                                JobListener* listener = nullptr,
                                const RunClock& clock = steady_clock());

}  // namespace semigeo::jobs
