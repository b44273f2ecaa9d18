#include "jobs/run/execution.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "io/files/error.hpp"
#include "io/files/read_error.hpp"
#include "io/files/write_error.hpp"
#include "jobs/plan/job_kind.hpp"
#include "jobs/run/scheduler.hpp"

namespace semigeo::jobs {
namespace {

std::vector<ScheduledJob> scheduled(const std::vector<PlannedJob>& plan,
                                    const std::vector<Estimate>& estimates) {
  std::vector<ScheduledJob> jobs(plan.size());
  for (std::size_t i = 0; i < plan.size(); ++i) {
    jobs[i] = {.after = plan[i].after, .estimate = estimates[i]};
    if (plan[i].up_to_date) jobs[i].state = JobState::kUpToDate;
    if (!is_readable(plan[i])) jobs[i].state = JobState::kFailed;
  }
  return jobs;
}

class Execution {
 public:
  Execution(std::vector<PlannedJob> plan, Runner& runner, const ExecutionSettings& settings,
            Progress& progress, JobListener* listener, const RunClock& clock)
      : plan_(std::move(plan)),
        runner_(runner),
        progress_(progress),
        listener_(listener),
        clock_(clock),
        estimates_(estimates_of(plan_, settings.estimates, settings.memory_bytes)),
        scheduler_(scheduled(plan_, estimates_), {.total = settings.total,
                                                  .most_seconds = settings.most_seconds,
                                                  .retries = settings.retries,
                                                  .fail_fast = settings.fail_fast,
                                                  .all_at_once = runner.orders_jobs()}),
        outcomes_(plan_.size()),
        begun_(plan_.size()) {}

  std::vector<JobOutcome> run() {
    tell_what_does_not_run();
    while (true) {
      start_jobs();
      if (scheduler_.running() == 0 || !runner_.waits()) break;
      std::visit([this](auto&& event) { handle(std::forward<decltype(event)>(event)); },
                 runner_.wait());
      if (scheduler_.stopping() && !std::exchange(cancelled_waiting_, true))
        runner_.cancel_waiting();
    }
    return std::move(outcomes_);
  }

 private:
  void tell_what_does_not_run() {
    for (std::size_t i = 0; i < plan_.size(); ++i) {
      if (!is_readable(plan_[i])) {
        begin(i);
        outcomes_[i].error = plan_[i].error;
        tell_end(i, JobState::kFailed);
      } else if (plan_[i].up_to_date) {
        outcomes_[i].state = JobState::kUpToDate;
      }
    }
  }

  void start_jobs() {
    std::vector<JobStart> jobs;
    while (const auto next = scheduler_.next(clock_())) {
      const std::size_t job = *next;
      if (!runner_.orders_jobs() && !has_inputs(job)) continue;
      const auto share = scheduler_.admit(job);
      if (!share) break;
      jobs.push_back({.number = job,
                      .planned = &plan_[job],
                      .estimate = estimates_[job],
                      .share = *share,
                      .attempt = scheduler_.attempts(job)});
    }
    if (jobs.empty()) return;
    std::ranges::sort(jobs, {}, &JobStart::number);
    runner_.start(jobs, [this](const std::string& line) { progress_.say(line); });
    if (runner_.orders_jobs()) return;
    for (const JobStart& job : jobs) {
      outcomes_[job.number].threads = job.share.cores;
      begin(job.number);
    }
  }

  /// Returns whether the job can begin with what is there now; if not, the job has ended.
  bool has_inputs(std::size_t job) {
    PlannedJob& planned = plan_[job];
    const JobKind& kind = *planned.job.kind;
    if (scheduler_.attempts(job) > 0) return true;
    try {
      if (!planned.inputs_are_there && kind.resolve_inputs(planned.job, keys_)) {
        end(job, JobState::kUpToDate);
        return false;
      }
    } catch (const io::Error& e) {
      // What the system refuses to read may be what the output was made of.
      const auto* refused = dynamic_cast<const io::ReadError*>(&e);
      if (refused == nullptr || refused->is_absent()) kind.remove_stale_output(planned.job);
      outcomes_[job].error = e.what();
      end(job, scheduler_.follows_failure(job) ? JobState::kSkipped : JobState::kFailed);
      return false;
    }
    kind.remove_stale_output(planned.job);
    return true;
  }

  void handle(JobBegun&& event) { begin(event.number); }

  void handle(WorkDone&& event) { progress_.worked(event.vertex_levels); }

  void handle(JobAnswered&& event) {
    const std::size_t job = event.number;
    progress_.worked(event.vertex_levels);
    begin(job);
    outcomes_[job] = std::move(event.outcome);
    const JobOutcome& outcome = outcomes_[job];
    if (outcome.state == JobState::kFailed && io::concerns_the_place(outcome.write_error)) {
      stop_at(job);
      return;
    }
    // A job that never ran because its inputs are missing is skipped. It has not failed itself.
    const bool skipped = outcome.state == JobState::kFailed && outcome.threads == 0 &&
                         scheduler_.follows_failure(job);
    end(job, skipped ? JobState::kSkipped : outcome.state);
  }

  void handle(JobLost&& event) {
    const std::size_t job = event.number;
    outcomes_[job].seconds = event.seconds;
    switch (scheduler_.lose(job, event.wanted)) {
      case Scheduler::Loss::kRetry:
        progress_.say("again: " + subject_of(plan_[job].job).string() + ": " + event.cause);
        break;
      case Scheduler::Loss::kFailed:
        begin(job);
        outcomes_[job].error = std::move(event.error);
        tell_end(job, JobState::kFailed);
        break;
      case Scheduler::Loss::kNotRun:
        break;
    }
  }

  void handle(StopAsked&& event) {
    if (event.requests > 0 && !scheduler_.stopping()) {
      progress_.say(runner_.stop_notice(scheduler_.running()));
      scheduler_.stop();
    }
    if (event.requests > 1) runner_.cancel_running();
  }

  /// Stops the run because no output can be written any more. The fault is not the job's, so the
  /// job has not run. Only the first such job is told.
  void stop_at(std::size_t job) {
    if (std::exchange(told_place_, true)) {
      outcomes_[job].error.clear();
    } else {
      progress_.say("stopping: " + outcomes_[job].error);
    }
    outcomes_[job].state = JobState::kNotRun;
    scheduler_.stop();
    scheduler_.lose(job, true);
  }

  void begin(std::size_t job) {
    outcomes_[job].attempts = scheduler_.attempts(job);
    if (begun_[job]) return;
    begun_[job] = true;
    progress_.job_started(shown_name(plan_[job].job));
    if (listener_ != nullptr) listener_->job_started(plan_[job]);
  }

  void end(std::size_t job, JobState state) {
    scheduler_.end(job, state);
    tell_end(job, state);
  }

  void tell_end(std::size_t job, JobState state) {
    outcomes_[job].state = state;
    if (state == JobState::kFailed) progress_.say("failed: " + outcomes_[job].error);
    progress_.job_ended(state != JobState::kFailed, bytes_to_read(plan_[job]));
    if (listener_ != nullptr) listener_->job_ended(plan_[job], outcomes_[job]);
  }

  std::vector<PlannedJob> plan_;  ///< Jobs that have begun have their actual inputs.
  Runner& runner_;
  Progress& progress_;
  JobListener* listener_;
  const RunClock& clock_;
  const std::vector<Estimate> estimates_;
  Scheduler scheduler_;
  OutputKeys keys_;
  std::vector<JobOutcome> outcomes_;
  std::vector<bool> begun_;  ///< Progress and listener were told of it.
  bool cancelled_waiting_ = false;
  bool told_place_ = false;  ///< It was told that no output can be written.
};

}  // namespace

RunClock steady_clock() {
  using Clock = std::chrono::steady_clock;
  return [start = Clock::now()] {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
}

std::vector<Estimate> estimates_of(const std::vector<PlannedJob>& plan, const Estimates& learned,
                                   std::uint64_t memory_bytes) {
  const EstimateContext context{.plan = plan, .learned = learned, .memory_bytes = memory_bytes};
  std::vector<Estimate> estimates(plan.size());
  for (std::size_t i = 0; i < plan.size(); ++i)
    if (!plan[i].up_to_date && is_readable(plan[i]))
      estimates[i] = plan[i].job.kind->estimate(plan[i], context);
  return estimates;
}

std::vector<JobOutcome> execute(std::vector<PlannedJob> plan, Runner& runner,
                                const ExecutionSettings& settings, Progress& progress,
                                JobListener* listener, const RunClock& clock) {
  return Execution(std::move(plan), runner, settings, progress, listener, clock).run();
}

}  // namespace semigeo::jobs
