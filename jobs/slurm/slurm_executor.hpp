#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "jobs/run/local_executor.hpp"
#include "jobs/slurm/slurm_stage.hpp"

namespace semigeo::jobs {

/// What was given to Slurm.
struct SubmittedStage {
  std::string name;  ///< the kind of its jobs
  std::string job;   ///< Slurm's number
  int tasks = 0;
};

struct SlurmOutcome {
  std::vector<JobOutcome> jobs;  ///< jobs[i] belongs to plan[i]
  std::vector<SubmittedStage> stages;
};

/// Runs the jobs that are not up to date as array jobs of Slurm, one for each kind, several jobs in
/// a task, and waits for them. All that the run and its tasks know of each other are files below
/// ARCHIVE/slurm/<run>, which must be at the same place on all machines, as must be the scans and
/// the program. That folder is removed if every job is done. A job is done if its output says so,
/// whatever became of its task. The first SIGINT or SIGTERM lets the running tasks end and cancels
/// the others, the second cancels all. io::Error if sbatch fails, or squeue does so for minutes.
SlurmOutcome run_on_slurm(const std::vector<PlannedJob>& plan, const JobParameters& parameters,
                          const std::filesystem::path& archive, const ExecutorOptions& options,
                          const SlurmOptions& slurm, Progress& progress,
                          JobListener* listener = nullptr);

}  // namespace semigeo::jobs
