#include "jobs/cli/execution_options.hpp"

#include <algorithm>
#include <cstdio>
#include <ctime>

#include "jobs/cli/table_options.hpp"

namespace semigeo::jobs::cli {
namespace {

using Options = ExecutionOptions;
using Table = ParameterTable<Options>;
using Integer = NumberIn<Options, int>;

constexpr auto kLimits = &Options::limits;

/// Returns the rows for the limits of the run and its jobs.
Table limit_rows() {
  return {
      {.name = "threads",
       .help = "Threads of all jobs at once; 0: one per core",
       .value = Integer{field<kLimits, &ExecutorOptions::threads>(), 0, 4096}},
      {.name = "memory",
       .help = "Memory of all jobs that run side by side (8G); 0: what is free",
       .value = Size<Options>{field<kLimits, &ExecutorOptions::memory_bytes>()}},
      {.name = "memory-per-job",
       .help = "Address space of one job (2G); 0: several times what it should need",
       .value = Size<Options>{field<kLimits, &ExecutorOptions::memory_per_job>()}},
      {.name = "timeout",
       .help = "End a job that takes longer (30min); 0: many times what it should take",
       .value = Duration<Options>{field<kLimits, &ExecutorOptions::timeout_seconds>()}},
  };
}

/// Returns the rows for failed jobs and for the end of the run.
Table end_rows() {
  return {
      {.name = "retries",
       .help = "Of a job that crashed, or that a limit ended",
       .value = Integer{field<kLimits, &ExecutorOptions::retries>(), 0, 100}},
      {.name = "keep-going",
       .help = "Go on when jobs fail: the default",
       .value = Flag<Options>{field<&Options::keep_going>()}},
      {.name = "fail-fast",
       .help = "Start nothing after the first failure",
       .value = Flag<Options>{field<kLimits, &ExecutorOptions::fail_fast>()},
       .excludes = "keep-going"},
      {.name = "time-limit",
       .help = "Start nothing that will not end in time (8h); 0: no limit",
       .value = Duration<Options>{field<kLimits, &ExecutorOptions::most_seconds>()},
       .in_configuration = false},
      {.name = "until",
       .help = "Start nothing that will not end before this time of day (06:00)",
       .value = Text<Options>{field<&Options::until>()},
       .in_configuration = false},
  };
}

/// Returns the rows for running jobs on other machines.
Table slurm_rows() {
  constexpr auto kSlurm = &Options::slurm;
  return {
      {.name = "executor",
       .help = "Where jobs run: here, or as an array job of Slurm, where --threads (0: one),\n"
               "--memory, --retries, ... hold for each task",
       .value = choice(field<&Options::executor>(),
                       {{"local", ExecutorKind::kLocal}, {"slurm", ExecutorKind::kSlurm}})},
      {.name = "scans-per-task",
       .help = "Scans of one task of Slurm; 0: so that it lasts about five minutes",
       .value = Integer{field<kSlurm, &SlurmOptions::scans_per_task>(), 0, 1000000}},
      {.name = "slurm-option",
       .help = "Passed on to sbatch (account=geo); may be repeated",
       .value = Texts<Options>{field<kSlurm, &SlurmOptions::sbatch_options>()}},
      {.name = "no-wait",
       .help = "Print the numbers of Slurm's jobs, and end. A later run picks up what is missing",
       .value = Flag<Options>{field<kSlurm, &SlurmOptions::wait>(), false},
       .in_configuration = false},
  };
}

/// Returns the rows for what is printed, and for runs that only plan.
Table report_rows() {
  return {
      {.name = "json",
       .help = "Results as JSON on stdout",
       .value = Flag<Options>{field<&Options::json>()},
       .in_configuration = false},
      {.name = "quiet",
       .help = "Print no progress, and failures at the end only",
       .value = Flag<Options>{field<&Options::quiet>()},
       .in_configuration = false},
      {.name = "verify",
       .help = "Read every array of what counts as up to date; make again what is damaged",
       .value = Flag<Options>{field<&Options::verify>()},
       .in_configuration = false},
      {.name = "dry-run",
       .help = "Say what would run, and why; write nothing",
       .value = Flag<Options>{field<&Options::dry_run>()},
       .in_configuration = false},
      {.name = "explain",
       .help = "Name everything because of which a scan is done: parameters, old and new, ...",
       .value = Flag<Options>{field<&Options::explain>()},
       .in_configuration = false},
      {.name = "dag",
       .help = "Print the graph of files and jobs, for Graphviz or as JSON; run nothing",
       .value = choice(field<&Options::graph>(),
                       {{"dot", GraphFormat::kDot}, {"json", GraphFormat::kJson}}),
       .in_configuration = false},
  };
}

/// Returns the seconds until the clock shows HH:MM next.
double seconds_until(const std::string& clock) {
  int hours = 0;
  int minutes = 0;
  char rest = 0;
  if (std::sscanf(clock.c_str(), "%2d:%2d%c", &hours, &minutes, &rest) != 2 || hours < 0 ||
      hours > 23 || minutes < 0 || minutes > 59)
    throw CLI::ValidationError("--until", "give a time of day such as 06:00");
  const std::time_t now = std::time(nullptr);
  std::tm day = *std::localtime(&now);
  day.tm_hour = hours;
  day.tm_min = minutes;
  day.tm_sec = 0;
  day.tm_isdst = -1;
  std::time_t then = std::mktime(&day);
  if (then <= now) {
    ++day.tm_mday;
    day.tm_isdst = -1;
    then = std::mktime(&day);
  }
  return std::difftime(then, now);
}

}  // namespace

const ParameterTable<ExecutionOptions>& execution_option_table() {
  static const Table table = joined({limit_rows(), end_rows(), slurm_rows(), report_rows()});
  return table;
}

void add_execution_options(CLI::App& command, ExecutionOptions& options) {
  add_table_options(command, execution_option_table(), options);
}

void complete(ExecutionOptions& options) {
  if (options.executor != ExecutorKind::kSlurm && !options.slurm.wait)
    throw CLI::ValidationError("--no-wait", "give --executor slurm with it");
  if (options.until.empty()) return;
  const double left = seconds_until(options.until);
  double& most = options.limits.most_seconds;
  most = most > 0 ? std::min(most, left) : left;
}

}  // namespace semigeo::jobs::cli
