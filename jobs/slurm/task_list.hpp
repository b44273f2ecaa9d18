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

// The files through which a run and its tasks on other machines of a cluster talk to each other. A
// task has several jobs, so that it lasts minutes.

/// Distributes jobs to tasks. result[k] holds the jobs of task k as indices into `seconds`, the
/// expected time of each job. The longest jobs come first, so that the jobs of a task have similar
/// sizes. Each task gets `per_task` jobs; 0 means as many as last about five minutes, in at most
/// 10,000 tasks.
std::vector<std::vector<std::size_t>> share_out(std::span<const double> seconds, int per_task);

/// The settings that all tasks of a list share.
struct TaskSettings {
  std::filesystem::path archive;
  int threads = 1;
  std::uint64_t memory_bytes = 0;  ///< Memory for the jobs that run at the same time.
  double timeout_seconds = 0;      ///< Limit for one job; 0: many times the estimate.
  int retries = 1;
  bool fail_fast = false;
  double deadline = 0;  ///< Jobs must end before it, in seconds since 1970; 0: none.
  friend bool operator==(const TaskSettings&, const TaskSettings&) = default;
};

/// Returns a line for the settings, then a line for each job: its JobRequest and the number of its
/// task, which is its index in `tasks`.
std::string task_list_text(const TaskSettings& settings,
                           const std::vector<std::vector<JobRequest>>& tasks);

/// A task as it is read from a list.
struct Task {
  TaskSettings settings;
  std::vector<JobRequest> jobs;  ///< Never empty.
};

/// Reads a task from a file with the text of `task_list_text`. Throws io::Error if the file cannot
/// be read, or if it has no such task.
Task read_task(const std::filesystem::path& list, int number, const JobKinds& kinds);

/// Returns the file of the results of a task: results/<number>.jsonl beside the list.
std::filesystem::path results_of(const std::filesystem::path& list, int number);
/// Returns the file to which Slurm and the task print: task-<number>.log beside the list.
std::filesystem::path log_of_task(const std::filesystem::path& list, int number);

/// The result of one job of a task. A job that is neither done nor failed may still be done.
struct TaskResult {
  JobOutcome outcome;     ///< Its `result` is empty.
  nlohmann::json result;  ///< The result as the job's kind writes it, or null.
};
/// The results of a task. The key is the job_id.
using TaskResults = std::map<std::string, TaskResult>;

/// Returns a line for each job: its job_id and JobReply, and the seconds, threads and attempts that
/// it took.
std::string results_text(const TaskResults& results);
/// Reads results. Damaged lines are passed over. A file that cannot be read has no results: the
/// outputs of the jobs tell what was done.
TaskResults read_results(const std::filesystem::path& file);

}  // namespace semigeo::jobs
