#include "jobs/slurm/slurm_executor.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <optional>
#include <utility>

#include "engine/child_process.hpp"
#include "io/files/error.hpp"
#include "jobs/archive/digest_cache.hpp"
#include "jobs/archive/utc_time.hpp"
#include "jobs/plan/job_inputs.hpp"
#include "jobs/run/drain.hpp"
#include "jobs/slurm/slurm_commands.hpp"
#include "jobs/slurm/task_list.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double kShortestPause = 2;
constexpr double kLongestPause = 15;
constexpr double kPauseOfElapsed = 0.1;
/// For so long squeue may fail: controllers are restarted, networks go away and come back.
constexpr double kPatience = 300;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A network disk may know the names in a folder as they were a while ago, until it is opened.
void look_again(const fs::path& folder) {
  std::error_code ignored;
  const fs::directory_iterator opened(folder, ignored);
}

class SlurmRun {
 public:
  SlurmRun(const std::vector<PlannedJob>& plan, const JobParameters& parameters,
           const fs::path& archive, const ExecutorOptions& options, const SlurmOptions& slurm,
           Progress& progress, JobListener* listener)
      : plan_(plan),
        parameters_(parameters),
        archive_(fs::absolute(archive)),
        options_(options),
        slurm_(slurm),
        inputs_(parameters.recognition),
        progress_(progress),
        listener_(listener),
        outcomes_(plan.size()),
        settled_(plan.size()),
        drain_(children_) {
    options_.threads = std::max(1, options.threads);
  }

  SlurmOutcome run() {
    const std::vector<std::size_t> jobs = sort_out();
    if (jobs.empty() || stopping_) return {std::move(outcomes_), {}};
    folder_ = archive_ / "slurm" / (utc_time() + '-' + std::to_string(getpid()));
    SlurmOutcome outcome;
    try {
      for (SlurmStage& stage :
           stages_of(plan_, jobs, parameters_, options_, slurm_, {archive_, folder_}))
        submit(std::move(stage));
    } catch (...) {
      if (stages_.empty()) remove_folder();  // nobody is going to read it
      throw;
    }
    for (const WatchedStage& watched : stages_)
      outcome.stages.push_back({watched.stage.array.name, watched.job, watched.stage.array.tasks});
    if (slurm_.wait) {
      watch();
      if (all_done()) remove_folder();
    }
    outcome.jobs = std::move(outcomes_);
    return outcome;
  }

 private:
  struct WatchedTask {
    std::vector<std::size_t> jobs;
    std::optional<FileStamp> seen = {};  ///< of the results that were read last
    TaskResults results = {};
    bool started = false;
    bool gone = false;   ///< was not in the queue the last time
    bool ended = false;  ///< nothing more will come of it
    bool lost = false;   ///< it ended without a result for some of its jobs
  };
  struct WatchedStage {
    SlurmStage stage;
    std::vector<WatchedTask> tasks = {};
    std::string job = {};  ///< Slurm's number
  };

  /// Ends with what need not run, and with what cannot; returns the others.
  std::vector<std::size_t> sort_out() {
    std::vector<std::size_t> jobs;
    for (std::size_t i = 0; i < plan_.size(); ++i) {
      if (plan_[i].up_to_date) {
        outcomes_[i].state = JobState::kUpToDate;
        settled_[i] = true;
      } else if (!plan_[i].error.empty()) {
        start(i);
        JobOutcome outcome;
        outcome.state = JobState::kFailed;
        outcome.error = plan_[i].error;
        settle(i, std::move(outcome));
      } else {
        jobs.push_back(i);
      }
    }
    return jobs;
  }

  void submit(SlurmStage stage) {
    for (const std::size_t before : stage.after) stage.array.after.push_back(stages_[before].job);
    WatchedStage watched{.stage = std::move(stage)};
    const SlurmArray& array = watched.stage.array;
    for (const std::vector<std::size_t>& jobs : watched.stage.tasks)
      watched.tasks.push_back({.jobs = jobs});
    watched.job = commands_.submit(array);
    progress_.say("submitted: " + array.name + " is Slurm's job " + watched.job + ", " +
                  std::to_string(array.tasks) + (array.tasks == 1 ? " task" : " tasks"));
    stages_.push_back(std::move(watched));
  }

  /// Until nothing is left in the queue.
  void watch() {
    for (;;) {
      const double pause =
          std::clamp(kPauseOfElapsed * seconds_since(start_), kShortestPause, kLongestPause);
      children_.wait(pause);
      stop_if_asked();
      bool all_ended = true;
      for (WatchedStage& watched : stages_) {
        look_at(watched);
        all_ended &= std::ranges::all_of(watched.tasks, &WatchedTask::ended);
      }
      if (all_ended) return;
    }
  }

  /// The queue first: what has left it has told its results.
  void look_at(WatchedStage& watched) {
    const auto queue = queue_of(watched.job);
    if (!queue) return;
    const fs::path& list = watched.stage.list;
    look_again(list.parent_path() / "results");
    for (const std::vector<std::size_t>& jobs : watched.stage.tasks)
      look_again(plan_[jobs.front()].job.output.parent_path());
    for (int number = 0; number < watched.stage.array.tasks; ++number) {
      WatchedTask& task = watched.tasks[static_cast<std::size_t>(number)];
      if (task.ended) continue;
      const auto at = queue->find(number);
      if (at != queue->end() && at->second.state == QueuedTask::State::kRunning) {
        task.started = true;
        for (const std::size_t job : task.jobs) start(job);
      }
      read_results_of(task, results_of(list, number));
      if (at != queue->end()) {
        task.gone = false;  // requeued, perhaps
        tell_reason(at->second);
        continue;
      }
      const bool all_settled =
          std::ranges::all_of(task.jobs, [this](std::size_t job) { return settled_[job]; });
      // Results may be a moment late on a network disk.
      if (all_settled || task.gone) end(watched.stage, task, log_of_task(list, number));
      task.gone = true;
    }
  }

  /// Says why tasks wait, if that is not for others to end: somebody may have to do something.
  void tell_reason(const QueuedTask& task) {
    static constexpr std::array kUsual = {"",           "None",      "Resources",        "Priority",
                                          "Dependency", "BeginTime", "JobArrayTaskLimit"};
    if (stopping_ || task.state == QueuedTask::State::kRunning || task.reason == reason_told_ ||
        std::ranges::find(kUsual, task.reason) != kUsual.end())
      return;
    reason_told_ = task.reason;
    progress_.say("waiting: Slurm gives " + task.reason +
                  " as the reason; if that does not pass, interrupt, and see --slurm-option");
  }

  /// Nothing if squeue fails; it is asked again, for a while.
  std::optional<std::map<int, QueuedTask>> queue_of(const std::string& job) {
    try {
      auto queue = commands_.queue(job);
      failing_since_.reset();
      return queue;
    } catch (const io::Error& e) {
      if (!failing_since_) {
        failing_since_ = Clock::now();
        progress_.say(std::string(e.what()) + "; it is asked again");
      }
      if (seconds_since(*failing_since_) > kPatience) throw;
      return std::nullopt;
    }
  }

  void read_results_of(WatchedTask& task, const fs::path& file) {
    const auto stamp = stamp_of(file);
    if (!stamp || stamp == task.seen) return;
    task.seen = stamp;
    task.results = read_results(file);
    for (const std::size_t job : task.jobs) {
      const auto at = task.results.find(job_id(plan_[job].job));
      if (settled_[job] || at == task.results.end()) continue;
      const bool done = has_output(job);
      if (done == (at->second.state == JobState::kDone) && at->second.state != JobState::kNotRun)
        settle(job, at->second);
    }
  }

  /// Of what the jobs before it have left.
  bool has_output(std::size_t job) {
    Job now = plan_[job].job;
    try {
      return inputs_.settle(now);
    } catch (const io::Error&) {
      return false;
    }
  }

  /// The outputs themselves have the last word.
  void end(const SlurmStage& stage, WatchedTask& task, const fs::path& log) {
    task.ended = true;
    // Slurm cancels what waits for a task that was killed.
    const bool waited_in_vain =
        !task.started && std::ranges::any_of(stage.after, [this](std::size_t before) {
          return std::ranges::any_of(stages_[before].tasks, &WatchedTask::lost);
        });
    for (const std::size_t job : task.jobs) {
      if (settled_[job]) continue;
      const Job& planned = plan_[job].job;
      const auto at = task.results.find(job_id(planned));
      JobOutcome outcome = at == task.results.end() ? JobOutcome{} : at->second;
      const bool was_cancelled = ending_ || (stopping_ && !task.started) || waited_in_vain;
      task.lost |= at == task.results.end() || outcome.state == JobState::kNotRun;
      if (has_output(job)) {
        outcome.state = JobState::kDone;
        outcome.error.clear();
      } else if (at == task.results.end() && !was_cancelled) {
        outcome.state = JobState::kFailed;
        outcome.error = subject_of(planned).string() + ": its task ended without a result; see " +
                        log.string() + ", and run again";
      } else if (outcome.state == JobState::kDone) {
        outcome.state = JobState::kFailed;
        outcome.error = subject_of(planned).string() + ": its " +
                        std::string(output_name_of(planned.kind)) + " was made, but is not at " +
                        planned.output.string() +
                        "; check that the archive is the same folder on all machines";
      }
      if (outcome.state != JobState::kNotRun) settle(job, std::move(outcome));
    }
  }

  void start(std::size_t job) {
    if (settled_[job] || outcomes_[job].attempts > 0) return;
    outcomes_[job].attempts = 1;
    const Job& started = plan_[job].job;
    progress_.job_started(started.kind == JobKind::kSurface ? started.name : job_id(started));
    if (listener_ != nullptr) listener_->job_started(plan_[job]);
  }

  void settle(std::size_t job, JobOutcome outcome) {
    start(job);
    settled_[job] = true;
    outcomes_[job] = std::move(outcome);
    const JobOutcome& known = outcomes_[job];
    if (const auto* result = std::get_if<SurfaceJobResult>(&known.result))
      progress_.worked(result->vertices * result->levels);
    if (known.state == JobState::kFailed && follows_failure(job))
      outcomes_[job].state = JobState::kSkipped;
    const bool done = known.state != JobState::kFailed;
    if (!done) progress_.say("failed: " + known.error);
    progress_.job_ended(done, bytes_to_read(plan_[job]));
    if (listener_ != nullptr) listener_->job_ended(plan_[job], known);
    if (!done && options_.fail_fast) cancel(false);
  }

  /// Whether what the job needs is not there because of another failure.
  bool follows_failure(std::size_t job) const {
    const std::vector<std::size_t>& after = plan_[job].after;
    return std::ranges::any_of(after,
                               [this](std::size_t before) {
                                 return outcomes_[before].state == JobState::kFailed ||
                                        outcomes_[before].state == JobState::kSkipped;
                               }) &&
           outcomes_[job].threads == 0;  // it never ran
  }

  void stop_if_asked() {
    const int requests = drain_.requests();
    if (requests > 0 && !stopping_) {
      progress_.say("stopping: running tasks may end; interrupt again to cancel them");
      cancel(false);
    }
    if (requests > 1 && !ending_) cancel(true);
  }

  void cancel(bool running_too) {
    if (running_too ? ending_ : stopping_) return;
    stopping_ = true;
    ending_ = running_too;
    for (const WatchedStage& watched : stages_) {
      try {
        running_too ? commands_.cancel(watched.job) : commands_.cancel_pending(watched.job);
      } catch (const io::Error& e) {
        progress_.say(e.what());
      }
    }
  }

  bool all_done() const {
    return std::ranges::all_of(outcomes_, [](const JobOutcome& outcome) {
      return outcome.state == JobState::kDone || outcome.state == JobState::kUpToDate;
    });
  }

  /// Its logs tell nothing any more.
  void remove_folder() const {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
    fs::remove(folder_.parent_path(), ignored);  // if it is empty
  }

  const std::vector<PlannedJob>& plan_;
  const JobParameters& parameters_;
  const fs::path archive_;
  ExecutorOptions options_;
  const SlurmOptions& slurm_;
  JobInputs inputs_;
  Progress& progress_;
  JobListener* listener_;
  SlurmCommands commands_;
  std::vector<JobOutcome> outcomes_;
  std::vector<bool> settled_;  ///< the outcome is known, and was told
  fs::path folder_;            ///< of this run, ARCHIVE/slurm/<run>
  std::vector<WatchedStage> stages_;
  std::optional<Clock::time_point> failing_since_;  ///< squeue
  std::string reason_told_;
  bool stopping_ = false;  ///< no more tasks begin
  bool ending_ = false;    ///< running ones are cancelled, too
  Clock::time_point start_ = Clock::now();
  engine::ChildProcesses children_;  ///< has none: it is what signals wake
  Drain drain_;
};

}  // namespace

SlurmOutcome run_on_slurm(const std::vector<PlannedJob>& plan, const JobParameters& parameters,
                          const fs::path& archive, const ExecutorOptions& options,
                          const SlurmOptions& slurm, Progress& progress, JobListener* listener) {
  return SlurmRun(plan, parameters, archive, options, slurm, progress, listener).run();
}

}  // namespace semigeo::jobs
