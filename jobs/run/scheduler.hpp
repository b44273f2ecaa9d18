#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/resources.hpp"
#include "jobs/archive/estimates.hpp"
#include "jobs/plan/job_state.hpp"

namespace semigeo::jobs {

/// The limits within which jobs are scheduled.
struct SchedulerOptions {
  engine::Amount total;      ///< Cores and bytes of all jobs that run side by side.
  double most_seconds = 0;   ///< Nothing starts that is not expected to end in time; 0: no limit.
  int retries = 1;           ///< Further attempts at a job whose process was lost.
  bool fail_fast = false;    ///< Nothing starts after the first failure.
  bool all_at_once = false;  ///< Every job may start now: the runner orders and admits them.
};

/// Holds what the scheduler knows about a job.
struct ScheduledJob {
  std::vector<std::size_t> after = {};  ///< Jobs that must have ended before; smaller numbers.
  Estimate estimate = {};
  JobState state = JobState::kNotRun;  ///< Other than kNotRun: the job does not run.
};

/// Decides which jobs run when, and what the end of a job means for the others. It is pure: it
/// knows jobs by their numbers, starts nothing, reads no file and no clock. Only one thread may use
/// it at a time.
///
/// The longest jobs come first. A job gets as many of the cores as its share of the time that is
/// left for what need not wait for another job, rounded: many small jobs get one thread each, a
/// huge one all of them. A job that does not fit into memory waits at the head of the queue, and
/// nothing overtakes it, so that it does not starve.
class Scheduler {
 public:
  Scheduler(std::vector<ScheduledJob> jobs, const SchedulerOptions& options);

  /// Returns the job that is to start next, or nothing while no job may start. `now` is in seconds
  /// since the run began.
  std::optional<std::size_t> next(double now) const;

  /// Starts the job that `next` returned: takes its cores and memory. Returns them, or nothing if
  /// the job has to wait until other jobs have ended.
  std::optional<engine::Amount> admit(std::size_t job);

  /// Ends a job, running or not, with a state other than kNotRun.
  void end(std::size_t job, JobState state);

  /// The consequence of a lost process of a running job.
  enum class Loss {
    kRetry,   ///< The job is going to start again.
    kFailed,  ///< The job has ended.
    kNotRun   ///< The loss was wanted: the job has not run.
  };
  /// Ends a running job whose process was lost, and returns what follows. `wanted` says that the
  /// run itself has ended the process.
  Loss lose(std::size_t job, bool wanted);

  /// Lets nothing start any more; what runs goes on.
  void stop() { stopping_ = true; }
  bool stopping() const { return stopping_; }

  std::size_t running() const { return running_; }
  int attempts(std::size_t job) const { return records_[job].attempts; }

  /// Returns whether a job on which this one depends has failed or was skipped.
  bool follows_failure(std::size_t job) const;

 private:
  struct Record {
    std::size_t waits_for = 0;  ///< Number of jobs before it that have not ended.
    std::vector<std::size_t> followers = {};
    std::optional<engine::Amount> share = {};  ///< What it has while it runs.
    int attempts = 0;
  };
  int threads_for(std::size_t job) const;
  bool may_start(std::size_t job, double now) const;
  void release(std::size_t job);

  std::vector<ScheduledJob> jobs_;
  SchedulerOptions options_;
  std::vector<Record> records_;
  engine::Resources resources_;
  std::vector<std::size_t> pending_;  ///< In the order in which jobs start.
  std::size_t running_ = 0;
  /// Seconds, on one thread, of what is running or waits for no other job.
  double seconds_left_ = 0;
  bool stopping_ = false;
};

}  // namespace semigeo::jobs
