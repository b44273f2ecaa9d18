#pragma once

#include <cstdint>
#include <vector>

#include "jobs/plan/plan.hpp"
#include "jobs/run/local_executor.hpp"
#include "jobs/slurm/slurm_executor.hpp"

namespace semigeo::jobs::cli {

/// Counts and costs of a run, for its last line.
struct RunSummary {
  std::int64_t done = 0;
  std::int64_t up_to_date = 0;
  std::int64_t failed = 0;
  std::int64_t skipped = 0;  ///< jobs whose inputs are missing, as others have failed
  std::int64_t not_run = 0;
  std::int64_t vertex_levels = 0;
  double wall_seconds = 0;
  double cpu_seconds = 0;
  double peak_bytes = 0;
  double rate() const {
    return wall_seconds > 0 ? static_cast<double>(vertex_levels) / wall_seconds : 0;
  }
};

/// Whether the scan could be looked at.
inline bool is_readable(const PlannedJob& planned) {
  return planned.error.empty();
}

/// What would run, and why; on stdout, as JSON or as text. In text `explain` names everything that
/// differs, a line each; JSON always does.
void print_plan(const std::vector<PlannedJob>& plan, bool json, bool explain);

/// What a run has done, as one JSON document. outcomes[i] belongs to plan[i].
void print_json(const std::vector<PlannedJob>& plan, const std::vector<JobOutcome>& outcomes,
                const SurfaceParameters& parameters, const RunSummary& summary);

/// The same in words: one line a scan whose file had to be repaired, one that was prepared, one
/// that fell into parts; then the failures, what became of a library, and the totals.
void print_text(const std::vector<PlannedJob>& plan, const std::vector<JobOutcome>& outcomes,
                const RunSummary& summary);

/// What nobody waits for: the numbers of Slurm's jobs, a line each, or as JSON.
void print_submitted(const std::vector<SubmittedStage>& stages, bool json);

}  // namespace semigeo::jobs::cli
