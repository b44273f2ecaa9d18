#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "engine/child_process.hpp"
#include "jobs/run/drain.hpp"
#include "jobs/run/execution.hpp"
#include "jobs/run/runner.hpp"

namespace semigeo::jobs {

/// The limits of the jobs of a run, and where they print. 0 means that the program decides.
struct ExecutorOptions {
  std::filesystem::path program;     ///< `PROGRAM job` is a worker.
  std::filesystem::path logs;        ///< Folder for what jobs print.
  int threads = 0;                   ///< Threads of all jobs at once; 0: one per core.
  std::uint64_t memory_bytes = 0;    ///< Memory of all jobs at once; 0: what is free.
  std::uint64_t memory_per_job = 0;  ///< Address space of one job; 0: several times the estimate.
  double timeout_seconds = 0;        ///< Wall time of one job; 0: many times the estimate.
  int retries = 1;                   ///< Further attempts at a job that a signal or a limit ended.
  bool fail_fast = false;            ///< Nothing starts after the first failure.
  Estimates estimates = {};          ///< What is known about scans.
  double most_seconds = 0;           ///< Nothing starts that would not end in time; 0: no limit.
  /// File for what workers print outside of jobs. If it is empty, the file is workers.log in
  /// `logs`; the folder then belongs to this run, and empty logs in it are removed at the end.
  /// Otherwise they are kept, because other runs may have just opened them.
  std::filesystem::path worker_log = {};
};

/// Runs jobs in child processes on this machine. A child does one job after the other; whatever a
/// job does to its process - a crash, an endless loop, a memory bomb - is the failure of that job
/// alone. Children die with this process.
class LocalRunner : public Runner {
 public:
  explicit LocalRunner(const ExecutorOptions& options);

  void start(const std::vector<JobStart>& jobs, const Say& say) override;
  RunnerEvent wait() override;
  std::string stop_notice(std::size_t running) const override;
  void cancel_running() override;

 private:
  using Child = engine::ChildProcesses::Id;
  struct Running {
    JobStart job;
    double timeout;
    RunClock clock;
  };
  void start(const JobStart& job);
  void hand_over(const JobStart& job);
  Child start_worker(const JobKind& first);
  RunnerEvent answered(std::map<Child, Running>::iterator at, const std::string& line);
  JobLost lost(std::map<Child, Running>::iterator at, const engine::ChildProcesses::Ended& ended);
  std::filesystem::path log_of(const Job& job) const;
  std::uint64_t address_space(const JobStart& job) const;
  double timeout_of(const JobStart& job) const;

  const ExecutorOptions options_;
  std::map<Child, Running> running_;
  std::vector<Child> idle_;
  std::deque<JobLost> unstarted_;  ///< Jobs for which there was no process.
  bool ending_ = false;
  engine::ChildProcesses children_;
  Drain drain_;
};

/// Returns the options of an execution on this machine: its cores and its free memory, where the
/// user has not given others.
ExecutionSettings execution_settings(const ExecutorOptions& options);

/// Makes the folders of logs and outputs, and removes from them what killed writers have left.
/// Throws io::Error if a folder cannot be made.
void prepare_folders(const std::vector<PlannedJob>& plan, const ExecutorOptions& options);

/// Runs the jobs of a plan that are not up to date in child processes on this machine; see
/// `execute`. Throws io::Error if a folder cannot be made.
std::vector<JobOutcome> run_jobs(const std::vector<PlannedJob>& plan,
                                 const ExecutorOptions& options, Progress& progress,
                                 JobListener* listener = nullptr);

}  // namespace semigeo::jobs
