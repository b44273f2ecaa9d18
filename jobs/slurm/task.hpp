#pragma once

#include <filesystem>

#include "jobs/plan/job_kind.hpp"

namespace semigeo::jobs {

/// Does the jobs of one task of a list (jobs/slurm/task_list.hpp) in child processes, as run_jobs
/// does those of a run, and writes what became of them to results_of(list, number), now and then
/// and at the end. Jobs whose outputs are complete meanwhile are left alone, so that a task may run
/// twice, at once or one after the other. `PROGRAM job` is a worker for jobs of these kinds.
/// Returns whether each job was done or has failed; if not, a signal or the deadline came before.
/// Throws io::Error if the list cannot be read or the results cannot be written.
bool run_task(const std::filesystem::path& list, int number, const std::filesystem::path& program,
              const JobKinds& kinds);

}  // namespace semigeo::jobs
