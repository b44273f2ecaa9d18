#pragma once

#include <functional>
#include <vector>

#include "jobs/archive/digest_cache.hpp"
#include "jobs/cli/execution_options.hpp"
#include "jobs/cli/run_report.hpp"
#include "jobs/plan/plan.hpp"

namespace semigeo::jobs::cli {

/// Where a plan comes from. Its folder, RunConfig::archive, has the lock, the journal and the logs.
struct PlanSource {
  /// Reads only. If something is to be run, it is called when the folder is ours.
  std::function<std::vector<PlannedJob>(DigestCache&)> plan;
  /// Before jobs run, in a folder that is ours and can be written.
  std::function<void(const std::vector<PlannedJob>&)> prepare = {};
  bool is_archive = true;  ///< has scans: what was learned of them is kept
  bool is_kept = true;     ///< else nobody else knows the folder: no lock, no journal
  /// Instead of the report of a run. outcomes[i] belongs to plan[i].
  std::function<void(const std::vector<PlannedJob>&, const std::vector<JobOutcome>& outcomes,
                     const RunSummary&)>
      print = {};
};

/// Makes the plan and runs it, or says what would run; prints results; returns an exit code.
int run_plan(const ExecutionOptions& options, const RunConfig& config, const PlanSource& source);

}  // namespace semigeo::jobs::cli
