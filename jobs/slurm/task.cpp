#include "jobs/slurm/task.hpp"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include "io/files/atomic_file.hpp"
#include "jobs/run/local_runner.hpp"
#include "jobs/slurm/task_list.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// The run that waits for the results reads them about as often.
constexpr std::chrono::seconds kWriteInterval{5};
/// It stands for "no time left", because 0 means "any".
constexpr double kNoTime = 1e-9;

/// Keeps the file of results up to date.
class Results : public JobListener {
 public:
  explicit Results(fs::path file) : file_(std::move(file)), results_(read_results(file_)) {}

  void job_started(const PlannedJob&) override {}
  void job_ended(const PlannedJob& planned, const JobOutcome& outcome) override {
    set(planned.job, outcome);
    if (Clock::now() - written_ >= kWriteInterval) write();
  }
  /// Records an outcome. If an earlier copy of the task has made the output, its result is kept.
  void set(const Job& job, const JobOutcome& outcome) {
    TaskResult& known = results_[job_id(job)];
    if (outcome.state == JobState::kUpToDate && known.outcome.state == JobState::kDone) return;
    known = {.outcome = outcome, .result = job.kind->result_to_json(outcome.result)};
  }
  void write() {
    io::write_file_atomically(file_, results_text(results_));
    written_ = Clock::now();
  }

 private:
  fs::path file_;
  TaskResults results_;
  Clock::time_point written_ = Clock::now();
};

double seconds_since_1970() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

ExecutorOptions options_of(const Task& task) {
  const TaskSettings& settings = task.settings;
  ExecutorOptions options{.program = {},
                          .logs = settings.archive / "logs",
                          .threads = settings.threads,
                          .memory_bytes = settings.memory_bytes,
                          .memory_per_job = task.jobs.front().address_space_bytes,
                          .timeout_seconds = settings.timeout_seconds,
                          .retries = settings.retries,
                          .fail_fast = settings.fail_fast,
                          .estimates = Estimates::read(settings.archive)};
  if (settings.deadline > 0)
    options.most_seconds = std::max(settings.deadline - seconds_since_1970(), kNoTime);
  return options;
}

}  // namespace

bool run_task(const fs::path& list, int number, const fs::path& program, const JobKinds& kinds) {
  const Task task = read_task(list, number, kinds);
  std::vector<PlannedJob> plan;
  std::uintmax_t bytes = 0;
  for (const JobRequest& request : task.jobs) {
    PlannedJob& planned = plan.emplace_back();
    planned.job = request.job;
    planned.scan = request.job.input;
    bytes += bytes_to_read(planned);
  }
  ExecutorOptions options = options_of(task);
  options.program = program;
  options.worker_log = log_of_task(list, number);
  Results results(results_of(list, number));
  Progress progress(std::ssize(plan), bytes);
  const std::vector<JobOutcome> outcomes = run_jobs(plan, options, progress, &results);
  for (std::size_t i = 0; i < plan.size(); ++i) results.set(plan[i].job, outcomes[i]);
  results.write();
  return std::ranges::count(outcomes, JobState::kNotRun, &JobOutcome::state) == 0;
}

}  // namespace semigeo::jobs
