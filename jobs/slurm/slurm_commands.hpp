#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace semigeo::jobs {

/// One array job: tasks 0 to tasks - 1 run the same script.
struct SlurmArray {
  std::string name;
  std::filesystem::path script;
  std::filesystem::path folder;  ///< where tasks run; takes their output, task-<number>.log
  int tasks = 1;
  int cpus = 1;                           ///< of a task, like the next two
  std::uint64_t memory_bytes = 0;         ///< rounded up to MiB; 0: what the cluster gives
  double seconds = 0;                     ///< rounded up to minutes; 0: what the cluster gives
  std::vector<std::string> after = {};    ///< jobs that must have ended well before
  std::vector<std::string> options = {};  ///< of sbatch; they outdo what is said above
};

/// What sbatch is given.
std::vector<std::string> sbatch_arguments(const SlurmArray& array);

/// A task that has not ended.
struct QueuedTask {
  enum class State { kPending, kRunning };
  State state = State::kPending;
  std::string reason = {};  ///< why it waits, in Slurm's word: "Resources", "PartitionTimeLimit"
  friend bool operator==(const QueuedTask&, const QueuedTask&) = default;
};

/// Slurm, by its programs sbatch, squeue and scancel. Every function throws io::Error that names
/// the program and says what it printed, if it fails or does not answer within a minute or two.
class SlurmCommands {
 public:
  /// Finds the programs in PATH.
  SlurmCommands();

  /// Returns the job's id, as the others take it.
  std::string submit(const SlurmArray& array) const;
  /// Those of the job's tasks that have not ended, by number.
  std::map<int, QueuedTask> queue(const std::string& job) const;
  /// Running tasks go on.
  void cancel_pending(const std::string& job) const;
  void cancel(const std::string& job) const;

 private:
  std::string sbatch_;
  std::string squeue_;
  std::string scancel_;
};

/// Of what `squeue --noheader --array --format "%K %T %r"` printed; other lines are passed over.
std::map<int, QueuedTask> parse_queue(const std::string& text);

}  // namespace semigeo::jobs
