#pragma once

#include <vector>

#include "jobs/plan/plan.hpp"
#include "jobs/run/run.hpp"
#include "jobs/slurm/slurm_runner.hpp"

namespace semigeo::jobs::cli {

/// Prints on stdout what would run, and why, as JSON or as text. In text `explain` adds a line for
/// everything that differs; JSON always has it.
void print_plan(const std::vector<PlannedJob>& plan, bool json, bool explain);

/// Prints on stdout what a run has done, as one JSON document.
void print_json(const RunResult& result);

/// Prints on stdout what a run has done, in words: what jobs tell about scans, a line each; then
/// the failures, what became of a library, and the totals.
void print_text(const RunResult& result);

/// Prints on stdout the numbers of Slurm's jobs, for which nobody waits: a line each, or as JSON.
void print_submitted(const std::vector<SubmittedStage>& stages, bool json);

}  // namespace semigeo::jobs::cli
