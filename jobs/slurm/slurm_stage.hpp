#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "jobs/run/local_runner.hpp"
#include "jobs/slurm/slurm_commands.hpp"

namespace semigeo::jobs {

/// Besides ExecutorOptions, which hold for each task: threads, memory, retries, ...
struct SlurmOptions {
  int scans_per_task = 0;                   ///< 0: so that a task lasts about five minutes
  std::vector<std::string> sbatch_options;  ///< accounts, partitions, ...
  bool wait = true;                         ///< else: submit, and that is all
};

/// Jobs of one kind as an array job, which waits for those of other stages.
struct SlurmStage {
  SlurmArray array;
  std::filesystem::path list;                   ///< its tasks, as read_task reads them
  std::vector<std::size_t> after = {};          ///< stages submitted before it, by their order
  std::vector<std::vector<std::size_t>> tasks;  ///< jobs of each, places in the plan
};

struct SlurmFolders {
  std::filesystem::path archive;
  std::filesystem::path run;  ///< exists; takes the list and the script. Both are absolute
};

/// Shares jobs of the plan out, those of each kind to the tasks of one stage, judges what a task
/// needs, and writes the lists of tasks and the scripts that sbatch is given, below a folder of
/// each stage. Stages come in the order of kinds; each waits for those that have jobs before its
/// own. Time and memory are generous: a task that takes more is killed with all its jobs. What
/// looks complete but is to be made again is removed, for tasks judge outputs by their headers.
/// io::Error if a file cannot be written.
std::vector<SlurmStage> stages_of(const std::vector<PlannedJob>& plan,
                                  const std::vector<std::size_t>& jobs,
                                  const ExecutorOptions& options, const SlurmOptions& slurm,
                                  const SlurmFolders& folders);

}  // namespace semigeo::jobs
