#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "jobs/run/local_runner.hpp"
#include "jobs/slurm/slurm_stage.hpp"
#include "jobs/stages/parameter.hpp"

namespace semigeo::jobs::cli {

/// Says where jobs run.
enum class ExecutorKind {
  kLocal,  ///< On this machine.
  kSlurm   ///< In an array job of Slurm.
};

/// Says how the graph of files and jobs is printed.
enum class GraphFormat { kNone, kDot, kJson };

/// Says how jobs of every kind are run, and what is printed. No byte of an output depends on it.
struct ExecutionOptions {
  ExecutorKind executor = ExecutorKind::kLocal;
  ExecutorOptions limits;
  SlurmOptions slurm;
  bool keep_going = false;  ///< --keep-going was given; it is the default.
  std::string until;        ///< Time of day, such as "06:00"; empty if no end was given.
  bool json = false;        ///< Results are printed as JSON.
  bool quiet = false;       ///< No progress is printed, and no failure before the end.
  bool verify = false;      ///< What counts as up to date is read completely.
  bool dry_run = false;     ///< Nothing is run.
  bool explain = false;     ///< Every reason for a job is printed.
  GraphFormat graph = GraphFormat::kNone;  ///< The graph is printed, and nothing is run.
};

/// Returns what each of the options is called and which values it may have, in the order of the
/// help text. An option is declared there and nowhere else.
const ParameterTable<ExecutionOptions>& execution_option_table();

/// Adds the options of execution_option_table() to a command. They are bound to `options`, which
/// must live until the command line is parsed.
void add_execution_options(CLI::App& command, ExecutionOptions& options);

/// Completes the options when the command line is parsed: a time of day becomes a number of
/// seconds. Throws CLI::ValidationError if some of them do not go together.
void complete(ExecutionOptions& options);

}  // namespace semigeo::jobs::cli
