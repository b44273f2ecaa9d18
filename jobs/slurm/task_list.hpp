#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "jobs/run/job_line.hpp"
#include "jobs/run/job_outcome.hpp"

namespace semigeo::jobs {

// What a run and the tasks of a cluster, which do its jobs on other machines, leave for each other
// in files. A task has several jobs, so that it lasts minutes.

/// Shares jobs out to tasks: tasks[k] holds indices into `seconds`, what each job is expected to
/// take. The longest jobs come first, so that tasks hold jobs of like size. `per_task` jobs each;
/// 0: as many as last about five minutes, in at most 10,000 tasks.
std::vector<std::vector<std::size_t>> share_out(std::span<const double> seconds, int per_task);

/// What holds for each task of a list.
struct TaskSettings {
  std::filesystem::path archive;
  int threads = 1;
  std::uint64_t memory_bytes = 0;  ///< of the jobs that it runs side by side
  double timeout_seconds = 0;      ///< of one job; 0: many times the estimate
  int retries = 1;
  bool fail_fast = false;
  double deadline = 0;  ///< seconds since 1970: start nothing that ends later; 0: none
  friend bool operator==(const TaskSettings&, const TaskSettings&) = default;
};

/// A line for the settings, then one for each job: its JobRequest and the number of its task, which
/// is its place in `tasks`.
std::string task_list_text(const TaskSettings& settings,
                           const std::vector<std::vector<JobRequest>>& tasks);

struct Task {
  TaskSettings settings;
  std::vector<JobRequest> jobs;  ///< not empty
};

/// Of a file that holds task_list_text. io::Error if it cannot be read, or has no such task.
Task read_task(const std::filesystem::path& list, int number, const JobKinds& kinds);

/// Where a task tells what became of its jobs: results/<number>.jsonl beside the list.
std::filesystem::path results_of(const std::filesystem::path& list, int number);
/// Where Slurm and the task itself print: task-<number>.log beside the list.
std::filesystem::path log_of_task(const std::filesystem::path& list, int number);

/// What a task tells of one job. Jobs that are neither done nor failed may still be done.
struct TaskResult {
  JobOutcome outcome;     ///< Its `result` is empty.
  nlohmann::json result;  ///< The result as the job's kind writes it; or null.
};
/// Results by job_id.
using TaskResults = std::map<std::string, TaskResult>;

/// Returns a line for each job: its job_id and JobReply, and the seconds, threads and attempts that
/// it took.
std::string results_text(const TaskResults& results);
/// Reads results. Passes over damaged lines; a file that is not there has none.
TaskResults read_results(const std::filesystem::path& file);

}  // namespace semigeo::jobs
