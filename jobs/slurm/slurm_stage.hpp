#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "jobs/run/local_runner.hpp"
#include "jobs/slurm/slurm_commands.hpp"

namespace semigeo::jobs {

/// The options of a run on Slurm. ExecutorOptions (threads, memory, retries, ...) hold for each
/// task.
struct SlurmOptions {
  int scans_per_task = 0;  ///< Jobs of a task; 0: as many as last about five minutes.
  std::vector<std::string> sbatch_options;  ///< Accounts, partitions, ...
  bool wait = true;                         ///< Wait for the jobs; otherwise only submit them.
};

/// The jobs of one kind as an array job of Slurm, which waits for the jobs of other stages.
struct SlurmStage {
  SlurmArray array;
  std::filesystem::path list;                   ///< File with its tasks, as `read_task` reads them.
  std::vector<std::size_t> after = {};          ///< Indices of the stages that must end before it.
  std::vector<std::vector<std::size_t>> tasks;  ///< Jobs of each task, as indices into the plan.
};

/// The folders of a run. Both paths are absolute.
struct SlurmFolders {
  std::filesystem::path archive;
  std::filesystem::path run;  ///< Existing folder for the lists and the scripts.
};

/// Distributes jobs of the plan to stages and tasks, with one stage for each kind of job, estimates
/// what a task needs, and writes the list of tasks and the script of each stage into a folder of
/// its own. Stages come in the order of kinds. Each waits for the stages with jobs that must end
/// before its own. Time and memory are generous, because a task that takes more is killed with all
/// its jobs. Outputs that look complete but must be made again are removed, because tasks judge
/// outputs by their headers. Throws io::Error if a file cannot be written.
std::vector<SlurmStage> stages_of(const std::vector<PlannedJob>& plan,
                                  const std::vector<std::size_t>& jobs,
                                  const ExecutorOptions& options, const SlurmOptions& slurm,
                                  const SlurmFolders& folders);

}  // namespace semigeo::jobs
