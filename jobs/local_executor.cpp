#include "jobs/local_executor.hpp"

#include <chrono>
#include <new>
#include <set>

#include "io/atomic_file.hpp"
#include "io/error.hpp"
#include "io/xdmf.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

/// Whether the sidecar could be made; if not, the dataset must be, too.
bool remake_sidecar(const SurfaceJob& job) {
  std::string text;
  try {
    text = io::sidecar_text(job.output);
  } catch (const io::Error&) {
    return false;
  }
  io::write_file_atomically(io::sidecar_of(job.output), text);
  return true;
}

JobOutcome run_job(const PlannedJob& planned, const SurfaceParameters& parameters,
                   const engine::RunContext& context) {
  const SurfaceJob& job = planned.job;
  JobOutcome outcome;
  try {
    if (!planned.sidecar_only || !remake_sidecar(job))
      outcome.result = run_surface_job(job, parameters, context);
    outcome.state = JobState::kDone;
  } catch (const std::bad_alloc&) {
    outcome.error = job.input.string() + ": not enough memory; free some or decimate the scan";
  } catch (const std::exception& e) {
    outcome.error = e.what();
  }
  return outcome;
}

}  // namespace

std::uintmax_t bytes_to_read(const PlannedJob& planned) {
  if (planned.up_to_date || planned.sidecar_only) return 0;
  std::error_code error;
  const auto size = fs::file_size(planned.job.input, error);
  return error ? 0 : size;
}

std::vector<JobOutcome> run_jobs(const std::vector<PlannedJob>& plan,
                                 const SurfaceParameters& parameters, engine::Workers& workers,
                                 Progress& progress, JobListener* listener) {
  const engine::RunContext context{workers, progress, {}};
  std::set<fs::path> folders;
  for (const PlannedJob& planned : plan) folders.insert(planned.job.output.parent_path());
  for (const fs::path& folder : folders) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
      throw io::Error(folder, "", "cannot be created: " + error.message(),
                      "check the output folder, its permissions and the free space");
    io::remove_stale_partials(folder);
  }

  std::vector<JobOutcome> outcomes;
  for (const PlannedJob& planned : plan) {
    if (planned.up_to_date) {
      outcomes.push_back({.state = JobState::kUpToDate, .error = {}, .result = {}, .seconds = 0});
      continue;
    }
    const auto start = std::chrono::steady_clock::now();
    progress.scan_started(planned.job.name);
    if (listener != nullptr) listener->job_started(planned);
    JobOutcome outcome;
    if (planned.error.empty()) {
      outcome = run_job(planned, parameters, context);
    } else {
      outcome.error = planned.error;
    }
    outcome.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (listener != nullptr) listener->job_ended(planned, outcome);
    progress.scan_ended(outcome.state == JobState::kDone, bytes_to_read(planned));
    if (outcome.state == JobState::kFailed) progress.say("failed: " + outcome.error);
    outcomes.push_back(std::move(outcome));
  }
  return outcomes;
}

}  // namespace semigeo::jobs
