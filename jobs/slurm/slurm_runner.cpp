#include "jobs/slurm/slurm_runner.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <utility>

#include "io/files/error.hpp"
#include "jobs/archive/utc_time.hpp"
#include "jobs/plan/job_kind.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

constexpr double kShortestPause = 2;
constexpr double kLongestPause = 15;
constexpr double kPauseOfElapsed = 0.1;
/// The seconds for which squeue may fail, because controllers are restarted and networks break down
/// for a while.
constexpr double kPatience = 300;

/// Opens a folder. A network disk may show the names as they were a while ago until that is done.
void refresh_folder(const fs::path& folder) {
  std::error_code ignored;
  const fs::directory_iterator opened(folder, ignored);
}

/// Returns what a task tells of a job, with its result in the type of the job's kind.
JobOutcome outcome_of(const TaskResult& told, const JobKind& kind) {
  JobOutcome outcome = told.outcome;
  try {
    outcome.result = kind.result_from_json(told.result);
  } catch (const nlohmann::json::exception&) {
    outcome.result.reset();  // the output itself decides whether the job is done
  }
  return outcome;
}

}  // namespace

SlurmRunner::SlurmRunner(const std::vector<PlannedJob>& plan, const fs::path& archive,
                         const ExecutorOptions& options, const SlurmOptions& slurm)
    : plan_(plan),
      archive_(fs::absolute(archive)),
      options_(options),
      slurm_(slurm),
      settled_(plan.size()),
      drain_(children_) {
  options_.threads = std::max(1, options.threads);
  all_done_ = std::ranges::all_of(plan, is_readable);
}

SlurmRunner::~SlurmRunner() {
  if (!stages_.empty() && slurm_.wait && all_done_ && unsettled_ == 0) remove_folder();
}

void SlurmRunner::start(const std::vector<JobStart>& jobs, const Say& say) {
  say_ = say;
  std::vector<std::size_t> numbers;
  numbers.reserve(jobs.size());
  for (const JobStart& job : jobs) numbers.push_back(job.number);
  unsettled_ = numbers.size();
  folder_ = archive_ / "slurm" / (utc_time() + '-' + std::to_string(getpid()));
  try {
    for (SlurmStage& stage : stages_of(plan_, numbers, options_, slurm_, {archive_, folder_}))
      submit(std::move(stage));
  } catch (...) {
    if (stages_.empty()) remove_folder();  // no task will read it
    throw;
  }
}

void SlurmRunner::submit(SlurmStage stage) {
  for (const std::size_t before : stage.after) stage.array.after.push_back(stages_[before].job);
  WatchedStage watched{.stage = std::move(stage)};
  const SlurmArray& array = watched.stage.array;
  for (const std::vector<std::size_t>& jobs : watched.stage.tasks)
    watched.tasks.push_back({.jobs = jobs});
  watched.job = commands_.submit(array);
  say_("submitted: " + array.name + " is Slurm's job " + watched.job + ", " +
       std::to_string(array.tasks) + (array.tasks == 1 ? " task" : " tasks"));
  stages_.push_back(std::move(watched));
}

std::vector<SubmittedStage> SlurmRunner::submitted() const {
  std::vector<SubmittedStage> stages;
  for (const WatchedStage& watched : stages_)
    stages.push_back({watched.stage.array.name, watched.job, watched.stage.array.tasks});
  return stages;
}

RunnerEvent SlurmRunner::wait() {
  while (events_.empty()) {
    const double pause = std::clamp(kPauseOfElapsed * clock_(), kShortestPause, kLongestPause);
    children_.wait(pause);
    if (const int requests = drain_.requests(); requests > requests_told_) {
      requests_told_ = requests;
      events_.emplace_back(StopAsked{requests});
      break;
    }
    for (WatchedStage& watched : stages_) watch(watched);
  }
  RunnerEvent event = std::move(events_.front());
  events_.pop_front();
  return event;
}

/// Reads what has happened to the tasks of a stage. It asks the queue first, because tasks that
/// have left the queue have written their results.
void SlurmRunner::watch(WatchedStage& watched) {
  if (std::ranges::all_of(watched.tasks, &WatchedTask::ended)) return;
  const auto queue = queue_of(watched.job);
  if (!queue) return;
  const fs::path& list = watched.stage.list;
  refresh_folder(list.parent_path() / "results");
  for (const std::vector<std::size_t>& jobs : watched.stage.tasks)
    refresh_folder(plan_[jobs.front()].job.output.parent_path());
  for (int number = 0; number < watched.stage.array.tasks; ++number) {
    WatchedTask& task = watched.tasks[static_cast<std::size_t>(number)];
    if (task.ended) continue;
    const auto at = queue->find(number);
    if (at != queue->end() && at->second.state == QueuedTask::State::kRunning) {
      if (!std::exchange(task.started, true))
        for (const std::size_t job : task.jobs) events_.emplace_back(JobBegun{job});
    }
    read_results_of(task, results_of(list, number));
    if (at != queue->end()) {
      task.gone = false;  // Slurm may have requeued it
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

/// Prints why tasks wait, unless the reason is a usual one: the user may have to do something.
void SlurmRunner::tell_reason(const QueuedTask& task) {
  static constexpr std::array kUsual = {"",           "None",      "Resources",        "Priority",
                                        "Dependency", "BeginTime", "JobArrayTaskLimit"};
  if (stopping_ || task.state == QueuedTask::State::kRunning || task.reason == reason_told_ ||
      std::ranges::find(kUsual, task.reason) != kUsual.end())
    return;
  reason_told_ = task.reason;
  say_("waiting: Slurm gives " + task.reason +
       " as the reason; if that does not pass, interrupt, and see --slurm-option");
}

/// Returns the queue, or nothing if squeue fails. For a while it is asked again.
std::optional<std::map<int, QueuedTask>> SlurmRunner::queue_of(const std::string& job) {
  try {
    auto queue = commands_.queue(job);
    failing_since_.reset();
    return queue;
  } catch (const io::Error& e) {
    if (!failing_since_) {
      failing_since_ = clock_();
      say_(std::string(e.what()) + "; it is asked again");
    }
    if (clock_() - *failing_since_ > kPatience) throw;
    return std::nullopt;
  }
}

void SlurmRunner::read_results_of(WatchedTask& task, const fs::path& file) {
  const auto stamp = stamp_of(file);
  if (!stamp || stamp == task.seen) return;
  task.seen = stamp;
  task.results = read_results(file);
  for (const std::size_t job : task.jobs) {
    const auto at = task.results.find(job_id(plan_[job].job));
    if (settled_[job] || at == task.results.end()) continue;
    const JobState told = at->second.outcome.state;
    if (told != JobState::kNotRun && has_output(job) == (told == JobState::kDone))
      settle(job, outcome_of(at->second, *plan_[job].job.kind));
  }
}

/// Returns whether the output is up to date with the inputs that the jobs before have made.
bool SlurmRunner::has_output(std::size_t job) {
  Job now = plan_[job].job;
  try {
    return now.kind->resolve_inputs(now, keys_);
  } catch (const io::Error&) {
    return false;
  }
}

/// Judges the jobs of a task that has ended. The outputs count, not what the task has told.
void SlurmRunner::end(const SlurmStage& stage, WatchedTask& task, const fs::path& log) {
  task.ended = true;
  // Slurm cancels what waits for a task that was killed.
  const bool waited_in_vain =
      !task.started && std::ranges::any_of(stage.after, [this](std::size_t before) {
        return std::ranges::any_of(stages_[before].tasks, &WatchedTask::lost);
      });
  const bool was_cancelled = ending_ || (stopping_ && !task.started) || waited_in_vain;
  for (const std::size_t job : task.jobs) {
    if (settled_[job]) continue;
    const Job& planned = plan_[job].job;
    const auto at = task.results.find(job_id(planned));
    const bool told = at != task.results.end();
    JobOutcome outcome = told ? outcome_of(at->second, *planned.kind) : JobOutcome{};
    task.lost |= !told || outcome.state == JobState::kNotRun;
    if (has_output(job)) {
      outcome.state = JobState::kDone;
      outcome.error.clear();
    } else if (!told && !was_cancelled) {
      outcome.state = JobState::kFailed;
      outcome.error = subject_of(planned).string() + ": its task ended without a result; see " +
                      log.string() + ", and run again";
    } else if (outcome.state == JobState::kDone) {
      outcome.state = JobState::kFailed;
      outcome.error = subject_of(planned).string() + ": its " + planned.kind->words().output +
                      " was made, but is not at " + planned.output.string() +
                      "; check that the archive is the same folder on all machines";
    }
    settle(job, std::move(outcome));
  }
}

void SlurmRunner::settle(std::size_t job, JobOutcome outcome) {
  settled_[job] = true;
  --unsettled_;
  all_done_ &= outcome.state == JobState::kDone;
  if (outcome.state == JobState::kNotRun) {
    events_.emplace_back(
        JobLost{.number = job, .wanted = true, .cause = {}, .error = {}, .seconds = 0});
    return;
  }
  const std::int64_t work = plan_[job].job.kind->vertex_levels(outcome.result);
  events_.emplace_back(JobAnswered{job, std::move(outcome), work});
}

std::string SlurmRunner::stop_notice(std::size_t) const {
  return "stopping: running tasks may end; interrupt again to cancel them";
}

void SlurmRunner::cancel_waiting() {
  if (!std::exchange(stopping_, true)) cancel(&SlurmCommands::cancel_pending);
}

void SlurmRunner::cancel_running() {
  stopping_ = true;
  if (!std::exchange(ending_, true)) cancel(&SlurmCommands::cancel);
}

void SlurmRunner::cancel(void (SlurmCommands::*command)(const std::string&) const) {
  for (const WatchedStage& watched : stages_) {
    try {
      (commands_.*command)(watched.job);
    } catch (const io::Error& e) {
      say_(e.what());
    }
  }
}

/// Removes the folder of the run, whose logs nobody needs any more.
void SlurmRunner::remove_folder() const {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
  fs::remove(folder_.parent_path(), ignored);  // if it is empty
}

}  // namespace semigeo::jobs
