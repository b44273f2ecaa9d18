#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace semigeo::jobs {

/// Describes an array job: tasks 0 to tasks - 1 run the same script.
struct SlurmArray {
  std::string name;
  std::filesystem::path script;
  /// Folder where tasks run. It takes their output, task-<number>.log.
  std::filesystem::path folder;
  int tasks = 1;
  int cpus = 1;  ///< Number of cores of a task.
  /// Memory of a task, rounded up to MiB; 0: the default of the cluster.
  std::uint64_t memory_bytes = 0;
  double seconds = 0;  ///< Time of a task, rounded up to minutes; 0: the default of the cluster.
  std::vector<std::string> after = {};    ///< Jobs that must have succeeded before it starts.
  std::vector<std::string> options = {};  ///< Options of sbatch. They override the fields above.
};

/// Returns the arguments of sbatch.
std::vector<std::string> sbatch_arguments(const SlurmArray& array);

/// A task that has not ended.
struct QueuedTask {
  /// The states of a task in the queue.
  enum class State { kPending, kRunning };
  State state = State::kPending;
  std::string reason = {};  ///< Why it waits, as Slurm says: "Resources", "PartitionTimeLimit".
  friend bool operator==(const QueuedTask&, const QueuedTask&) = default;
};

/// Runs Slurm's programs sbatch, squeue and scancel. Every function throws io::Error, which names
/// the program and says what it printed, if the program fails or does not answer within a minute or
/// two.
class SlurmCommands {
 public:
  /// Finds the programs in PATH.
  SlurmCommands();

  /// Submits a job and returns its id, as the other functions take it.
  std::string submit(const SlurmArray& array) const;
  /// Returns the tasks of the job that have not ended, by number.
  std::map<int, QueuedTask> queue(const std::string& job) const;
  /// Cancels the tasks that wait; running tasks go on.
  void cancel_pending(const std::string& job) const;
  /// Cancels all tasks.
  void cancel(const std::string& job) const;

 private:
  std::string sbatch_;
  std::string squeue_;
  std::string scancel_;
};

/// Reads the output of `squeue --noheader --array --format "%K %T %r"`. Other lines are passed
/// over.
std::map<int, QueuedTask> parse_queue(const std::string& text);

}  // namespace semigeo::jobs
