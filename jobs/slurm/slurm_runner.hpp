#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/child_process.hpp"
#include "jobs/archive/digest_cache.hpp"
#include "jobs/plan/output_keys.hpp"
#include "jobs/run/drain.hpp"
#include "jobs/run/execution.hpp"
#include "jobs/run/runner.hpp"
#include "jobs/slurm/slurm_commands.hpp"
#include "jobs/slurm/slurm_stage.hpp"
#include "jobs/slurm/task_list.hpp"

namespace semigeo::jobs {

/// An array job that Slurm has taken.
struct SubmittedStage {
  std::string name;  ///< "semigeo-surface": names the kind of its jobs.
  std::string job;   ///< Id of the job in Slurm.
  int tasks = 0;
};

/// Runs jobs as array jobs of Slurm, one for each kind, several jobs in a task. All that the run
/// and its tasks know of each other are files below ARCHIVE/slurm/<run>, which must be at the same
/// place on all machines, as must be the scans and the program. That folder is removed if every job
/// is done. A job is done if its output says so, whatever became of its task. `start` throws
/// io::Error if sbatch fails, `wait` if squeue fails for minutes.
class SlurmRunner : public Runner {
 public:
  /// The plan must outlive the runner.
  SlurmRunner(const std::vector<PlannedJob>& plan, const std::filesystem::path& archive,
              const ExecutorOptions& options, const SlurmOptions& slurm);
  ~SlurmRunner() override;

  bool orders_jobs() const override { return true; }
  bool waits() const override { return slurm_.wait; }
  void start(const std::vector<JobStart>& jobs, const Say& say) override;
  RunnerEvent wait() override;
  std::string stop_notice(std::size_t running) const override;
  void cancel_waiting() override;
  void cancel_running() override;

  /// Returns the stages that were submitted to Slurm.
  std::vector<SubmittedStage> submitted() const;

 private:
  struct WatchedTask {
    std::vector<std::size_t> jobs;
    std::optional<FileStamp> seen = {};  ///< Stamp of the results that were read last.
    TaskResults results = {};
    bool started = false;
    bool gone = false;   ///< It was not in the queue the last time.
    bool ended = false;  ///< It has ended, and its jobs were judged.
    bool lost = false;   ///< It ended without a result for some of its jobs.
  };
  struct WatchedStage {
    SlurmStage stage;
    std::vector<WatchedTask> tasks = {};
    std::string job = {};  ///< Id of the job in Slurm.
  };
  void submit(SlurmStage stage);
  void watch(WatchedStage& watched);
  void tell_reason(const QueuedTask& task);
  std::optional<std::map<int, QueuedTask>> queue_of(const std::string& job);
  void read_results_of(WatchedTask& task, const std::filesystem::path& file);
  bool has_output(std::size_t job);
  void end(const SlurmStage& stage, WatchedTask& task, const std::filesystem::path& log);
  void settle(std::size_t job, JobOutcome outcome);
  void cancel(void (SlurmCommands::*command)(const std::string&) const);
  void remove_folder() const;

  const std::vector<PlannedJob>& plan_;
  const std::filesystem::path archive_;
  ExecutorOptions options_;
  const SlurmOptions slurm_;
  SlurmCommands commands_;
  OutputKeys keys_;
  std::filesystem::path folder_;  ///< ARCHIVE/slurm/<run>
  std::vector<WatchedStage> stages_;
  Say say_;
  std::vector<bool> settled_;  ///< The job was answered or lost.
  std::size_t unsettled_ = 0;
  bool all_done_;
  std::deque<RunnerEvent> events_;
  std::optional<double> failing_since_;  ///< Since when squeue fails.
  std::string reason_told_;
  int requests_told_ = 0;
  bool stopping_ = false;  ///< No more tasks begin.
  bool ending_ = false;    ///< Running tasks are cancelled, too.
  RunClock clock_ = steady_clock();
  engine::ChildProcesses children_;  ///< Has no children: signals wake it.
  Drain drain_;
};

}  // namespace semigeo::jobs
