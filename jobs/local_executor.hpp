#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/parallel.hpp"
#include "jobs/plan.hpp"
#include "jobs/progress.hpp"
#include "jobs/stages/surface_job.hpp"

namespace semigeo::jobs {

enum class JobState { kDone, kUpToDate, kFailed };

struct JobOutcome {
  JobState state = JobState::kFailed;
  std::string error;                       ///< of a failed job: one sentence
  std::optional<SurfaceJobResult> result;  ///< of a job that made a dataset
  double seconds = 0;
};

/// Is told of each job that runs, in the thread that called run_jobs.
class JobListener {
 public:
  virtual ~JobListener() = default;
  virtual void job_started(const PlannedJob& planned) = 0;
  virtual void job_ended(const PlannedJob& planned, const JobOutcome& outcome) = 0;
};

/// By what the time that a job takes is judged: the size of its scan, 0 if that is not read.
std::uintmax_t bytes_to_read(const PlannedJob& planned);

/// Runs the jobs that are not up to date, one after the other, each on all workers. A job that
/// fails never harms another. outcomes[i] belongs to plan[i].
std::vector<JobOutcome> run_jobs(const std::vector<PlannedJob>& plan,
                                 const SurfaceParameters& parameters, engine::Workers& workers,
                                 Progress& progress, JobListener* listener = nullptr);

}  // namespace semigeo::jobs
