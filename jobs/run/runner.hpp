#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "engine/resources.hpp"
#include "jobs/run/job_outcome.hpp"

namespace semigeo::jobs {

/// A job that is to be started now.
struct JobStart {
  std::size_t number;         ///< Its index in the plan.
  const PlannedJob* planned;  ///< Lives as long as the runner is used.
  Estimate estimate;          ///< Its expected needs.
  engine::Amount share;       ///< The cores and bytes that it was admitted with.
  int attempt;                ///< The number of the attempt, from 1.
};

/// A job has begun, where that is known only later than its start.
struct JobBegun {
  std::size_t number;
};
/// Work was done since the last event, in vertices times levels.
struct WorkDone {
  std::int64_t vertex_levels;
};
/// A job has ended: it is done, or has failed and said why.
struct JobAnswered {
  std::size_t number;
  JobOutcome outcome;
  std::int64_t vertex_levels = 0;  ///< Work that was not told before.
};
/// The process of a job has ended without an answer.
struct JobLost {
  std::size_t number;
  bool wanted;        ///< The run itself has ended it, or a signal to all of the run.
  std::string cause;  ///< "crashed (signal 11, Segmentation fault)"
  std::string error;  ///< The sentence about the failure, if the job is not tried again.
  double seconds;
};
/// Signals have asked the run to stop.
struct StopAsked {
  int requests;  ///< Number of signals so far.
};
/// What Runner::wait reports.
using RunnerEvent = std::variant<JobBegun, WorkDone, JobAnswered, JobLost, StopAsked>;

/// Tells people one line.
using Say = std::function<void(const std::string&)>;

/// Runs jobs somewhere: in child processes, on a cluster, or nowhere at all in a test. Used by one
/// thread.
class Runner {
 public:
  virtual ~Runner() = default;

  /// Returns whether the runner itself begins jobs in their order and admits them by cores and
  /// memory. It is then given all jobs at once, before the jobs on which they depend have ended.
  virtual bool orders_jobs() const { return false; }
  /// Returns whether the run waits for its jobs; if not, it ends when they have been started.
  virtual bool waits() const { return true; }

  /// Starts jobs. `say` is valid until the execution ends. Throws io::Error or std::system_error if
  /// they cannot be started.
  virtual void start(const std::vector<JobStart>& jobs, const Say& say) = 0;
  /// Waits for the next event. Called only while jobs are running; each of them is answered or lost
  /// once.
  virtual RunnerEvent wait() = 0;

  /// Returns what people are told when a signal asks the run to stop.
  virtual std::string stop_notice(std::size_t running) const = 0;
  /// Loses the jobs that have been started but have not begun.
  virtual void cancel_waiting() {}
  /// Ends the jobs that are running.
  virtual void cancel_running() = 0;
};

}  // namespace semigeo::jobs
