#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "jobs/archive/digest_cache.hpp"
#include "jobs/cli/execution_options.hpp"
#include "jobs/plan/plan.hpp"
#include "jobs/run/run.hpp"

namespace semigeo::jobs::cli {

/// Where a plan comes from, and the folder that has the lock, the journal and the logs of its run.
struct PlanSource {
  std::filesystem::path home;
  /// Makes the plan. It reads only. If something is to be run, it is called when the folder belongs
  /// to the run.
  std::function<std::vector<PlannedJob>(DigestCache&)> plan;
  /// Prepares a folder that belongs to the run and can be written, before jobs run.
  std::function<void(const std::vector<PlannedJob>&)> prepare = {};
  bool is_archive = true;  ///< The folder has scans: what was learned of them is kept.
  bool is_kept = true;     ///< Others know the folder; if not, there is neither lock nor journal.
  /// Prints the results instead of the report of a run.
  std::function<void(const RunResult&)> print = {};
};

/// Makes the plan and runs it, or says what would run. Prints results and returns an exit code.
int run_plan(const ExecutionOptions& options, const PlanSource& source);

}  // namespace semigeo::jobs::cli
