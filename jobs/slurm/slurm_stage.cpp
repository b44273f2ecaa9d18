#include "jobs/slurm/slurm_stage.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <numeric>
#include <optional>
#include <set>

#include "io/files/atomic_file.hpp"
#include "io/files/error.hpp"
#include "jobs/plan/job_kind.hpp"
#include "jobs/run/job_logs.hpp"
#include "jobs/slurm/task_list.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

constexpr double kMemoryFactor = 1.5;
constexpr std::uint64_t kTaskMemory = std::uint64_t{512}
                                      << 20;  // memory of the process of the task itself
constexpr double kTimeFactor = 4;
constexpr double kTimeoutFactor = 10;
constexpr double kLeastTimeout = 600;

double seconds_since_1970() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw io::Error(folder, "", "cannot be created: " + error.message(),
                    "check the archive, its permissions and the free space");
}

/// Returns the text as one word of a shell.
std::string quoted(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + '\'';
}

/// Removes outputs that are damaged behind a good header, because tasks judge by headers. Removes
/// outputs of other inputs too, because the jobs after a task that never begins must not use them.
void remove_damaged(const PlannedJob& planned) {
  const JobKind& kind = *planned.job.kind;
  kind.remove_stale_output(planned.job);
  if (is_complete(planned.job)) kind.discard_output(planned.job);
}

/// Makes the paths absolute, because tasks run in another folder.
Job with_absolute_paths(Job job) {
  job.input = fs::absolute(job.input);
  job.output = fs::absolute(job.output);
  return job;
}

/// Holds what each task of a stage gets. It is enough for the task that needs most.
struct Needs {
  double bytes = 0;        ///< Memory of the jobs that run at the same time.
  double seconds = 0;      ///< Time of all jobs.
  double longest_job = 0;  ///< Time of the longest job, in seconds.
};

Needs needs_of(const SlurmStage& stage, const std::vector<Estimate>& estimates, int threads) {
  Needs most;
  for (const std::vector<std::size_t>& jobs : stage.tasks) {
    std::vector<double> bytes;
    double seconds = 0;
    for (const std::size_t job : jobs) {
      bytes.push_back(estimates[job].peak_bytes);
      seconds += estimates[job].seconds / threads;
      most.longest_job = std::max(most.longest_job, estimates[job].seconds);
    }
    std::ranges::sort(bytes, std::greater());
    bytes.resize(std::min(bytes.size(), static_cast<std::size_t>(threads)));
    most.bytes = std::max(most.bytes, std::accumulate(bytes.begin(), bytes.end(), 0.0));
    most.seconds = std::max(most.seconds, seconds);
  }
  return most;
}

TaskSettings size_up(SlurmArray& array, const Needs& needs, const ExecutorOptions& options) {
  TaskSettings settings{.archive = {},
                        .threads = array.cpus,
                        .memory_bytes = options.memory_bytes,
                        .timeout_seconds = options.timeout_seconds,
                        .retries = options.retries,
                        .fail_fast = options.fail_fast};
  array.memory_bytes = options.memory_bytes;
  if (options.memory_bytes == 0) {
    settings.memory_bytes = static_cast<std::uint64_t>(kMemoryFactor * needs.bytes);
    array.memory_bytes = settings.memory_bytes + kTaskMemory;
  }
  if (settings.timeout_seconds <= 0)
    settings.timeout_seconds = std::max(kLeastTimeout, kTimeoutFactor * needs.longest_job);
  // A job that hangs must not use up the time of the other jobs of its task.
  array.seconds = kTimeFactor * needs.seconds + (1 + options.retries) * settings.timeout_seconds;
  if (options.most_seconds > 0) settings.deadline = seconds_since_1970() + options.most_seconds;
  return settings;
}

/// The inputs that all stages of a run share.
struct StageInputs {
  const std::vector<PlannedJob>& plan;
  const ExecutorOptions& options;
  const SlurmOptions& slurm;
  const SlurmFolders& folders;
  std::vector<Estimate> estimates;
  int threads;
};

JobRequest request_of(const PlannedJob& planned, const StageInputs& inputs) {
  return {.job = with_absolute_paths(planned.job),
          .threads = inputs.threads,
          .address_space_bytes = inputs.options.memory_per_job,
          .log = log_path(inputs.folders.archive / "logs", planned.job)};
}

SlurmStage stage_of(const JobKind& kind, const std::vector<std::size_t>& jobs,
                    const StageInputs& inputs) {
  const std::string& name = kind.words().kind;
  const fs::path folder = inputs.folders.run / name;
  SlurmStage stage{.array = {.name = "semigeo-" + name,
                             .script = folder / "task.sh",
                             .folder = folder,
                             .cpus = inputs.threads,
                             .options = inputs.slurm.sbatch_options},
                   .list = folder / "tasks.jsonl",
                   .tasks = {}};
  std::vector<double> seconds;
  seconds.reserve(jobs.size());
  for (const std::size_t job : jobs)
    seconds.push_back(inputs.estimates[job].seconds / inputs.threads);
  std::vector<std::vector<JobRequest>> requests;
  for (const std::vector<std::size_t>& places : share_out(seconds, inputs.slurm.scans_per_task)) {
    stage.tasks.emplace_back();
    requests.emplace_back();
    for (const std::size_t place : places) {
      const PlannedJob& planned = inputs.plan[jobs[place]];
      remove_damaged(planned);
      stage.tasks.back().push_back(jobs[place]);
      requests.back().push_back(request_of(planned, inputs));
    }
  }
  stage.array.tasks = static_cast<int>(stage.tasks.size());
  TaskSettings settings =
      size_up(stage.array, needs_of(stage, inputs.estimates, inputs.threads), inputs.options);
  settings.archive = inputs.folders.archive;
  make_folder(folder / "results");
  io::write_file_atomically(stage.list, task_list_text(settings, requests));
  io::write_file_atomically(stage.array.script, "#!/bin/sh\nexec " +
                                                    quoted(inputs.options.program.string()) +
                                                    " job --list " + quoted(stage.list.string()) +
                                                    " --task \"$SLURM_ARRAY_TASK_ID\"\n");
  return stage;
}

}  // namespace

std::vector<SlurmStage> stages_of(const std::vector<PlannedJob>& plan,
                                  const std::vector<std::size_t>& jobs,
                                  const ExecutorOptions& options, const SlurmOptions& slurm,
                                  const SlurmFolders& folders) {
  const StageInputs inputs{.plan = plan,
                           .options = options,
                           .slurm = slurm,
                           .folders = folders,
                           .estimates = estimates_of(plan, options.estimates, options.memory_bytes),
                           .threads = std::max(1, options.threads)};
  // Plans are made in the order of kinds: those of the jobs before a job come first.
  std::vector<const JobKind*> kinds;
  for (const std::size_t job : jobs)
    if (std::ranges::find(kinds, plan[job].job.kind) == kinds.end())
      kinds.push_back(plan[job].job.kind);
  std::vector<SlurmStage> stages;
  std::vector<std::optional<std::size_t>> stage_with(plan.size());  // the stage that has the job
  for (const JobKind* kind : kinds) {
    std::vector<std::size_t> of_kind;
    std::set<std::size_t> after;
    for (const std::size_t job : jobs) {
      if (plan[job].job.kind != kind) continue;
      of_kind.push_back(job);
      stage_with[job] = stages.size();
      for (const std::size_t before : plan[job].after)
        if (stage_with[before]) after.insert(*stage_with[before]);
    }
    stages.push_back(stage_of(*kind, of_kind, inputs));
    stages.back().after.assign(after.begin(), after.end());
  }
  return stages;
}

}  // namespace semigeo::jobs
