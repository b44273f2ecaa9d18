#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "jobs/archive/digest_cache.hpp"
#include "jobs/cli/execution_options.hpp"
#include "jobs/cli/run_report.hpp"
#include "jobs/plan/plan.hpp"
#include "jobs/run/drain.hpp"
#include "jobs/run/run.hpp"

namespace semigeo::jobs::cli {

/// The function that makes a plan, and the folder for the lock, the journal and the logs of its
/// run.
struct PlanSource {
  std::filesystem::path home;  ///< Folder for the lock, the journal and the logs.
  /// Makes the plan and writes nothing. If jobs will run, it is called after the folder was locked.
  std::function<std::vector<PlannedJob>(DigestCache&)> plan;
  /// Prepares the folder after it was locked, before jobs run. It may write.
  std::function<void(const std::vector<PlannedJob>&)> prepare = {};
  bool is_archive = true;       ///< The folder is an archive; rates of its jobs are learned.
  bool is_kept = true;          ///< The folder is kept; otherwise it gets neither lock nor journal.
  PassedOver passed_over = {};  ///< Files that were found and are no scans, for the journal.
  bool must_write = false;      ///< The folder must be writable even if no job has to run.
  /// Prints the results instead of the report of a run.
  std::function<void(const RunResult&)> print = {};
  /// Returns what the report says besides the jobs. It is called after the plan was made.
  std::function<RunNotes()> notes = [] { return RunNotes(); };
};

/// As long as it exists, SIGINT and SIGTERM end the process at once with kStoppedEarly. It is for
/// what comes before a plan and writes nothing, such as the search for scans.
class InterruptibleSearch {
 public:
  InterruptibleSearch();

 private:
  EarlySignals signals_;
  EndAtOnce end_;
};

/// Makes the plan and runs it, or says which jobs would run. Prints results and returns an exit
/// code.
int run_plan(const ExecutionOptions& options, const PlanSource& source);

}  // namespace semigeo::jobs::cli
