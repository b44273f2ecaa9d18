#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "jobs/archive/find_scans.hpp"
#include "jobs/cli/failures.hpp"
#include "jobs/plan/job_kind.hpp"
#include "jobs/plan/plan.hpp"
#include "jobs/run/run.hpp"
#include "jobs/slurm/slurm_runner.hpp"

namespace semigeo::jobs::cli {

/// What a report says besides the jobs.
struct RunNotes {
  PassedOver passed_over = {};  ///< The files that the search has passed over.
  JobSummary leftovers = {};    ///< What the archive has of scans that are gone; or no text.
  /// Each failure, and what stopped the run, was printed in the same place before.
  bool failures_were_told = false;
  std::filesystem::path home = {};  ///< Folder whose journal has the details; empty: none.
};

/// Prints on stdout which jobs would run, and why, as JSON or as text. In text `explain` adds a
/// line for each difference; JSON always has them.
void print_plan(const std::vector<PlannedJob>& plan, bool json, bool explain,
                const RunNotes& notes = {});

/// Prints on stdout what a run has done, as one JSON document.
void print_json(const RunResult& result, const RunNotes& notes = {});

/// Prints on stdout what a run has done as text: the reports of its jobs, then the failures, the
/// summary of a library, the notes, and the totals. Many reports and failures are summed up, so
/// that the end of a large run fits on a screen of 24 lines.
void print_run(const RunResult& result, const RunNotes& notes = {});

/// Prints on stdout why no output could be written any more, unless it was told there before.
void print_stop(const RunResult& result, bool told);

/// Returns the jobs that have failed.
std::vector<Failure> failures_of(const RunResult& result);

/// Prints on stdout the files that were passed over as text, if there are any.
void print_passed_over(const PassedOver& passed_over);

/// Adds the files that were passed over to a document, if there are any.
void add_passed_over(nlohmann::json& document, const PassedOver& passed_over);

/// Prints on stdout the ids of the jobs of Slurm for which the program does not wait, a line each
/// or as JSON.
void print_submitted(const std::vector<SubmittedStage>& stages, bool json);

}  // namespace semigeo::jobs::cli
