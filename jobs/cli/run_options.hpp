#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "jobs/plan/config.hpp"
#include "jobs/run/local_executor.hpp"
#include "jobs/slurm/slurm_executor.hpp"

namespace semigeo::jobs::cli {

/// What the command line of `semigeo run` says, word by word.
struct RunOptions {
  RunConfig config;
  std::string surface = "curved";
  std::string coordinates = "semigeodesic";
  std::string schedule = "uniform";
  std::string decimate;
  std::string rescale = "size";
  bool no_remesh = false;
  int level = -1;  ///< not told
  std::string compression = "deflate";
  bool json = false;
  ExecutorOptions executor;
  std::string where = "local";  ///< or "slurm"
  SlurmOptions slurm;
  bool keep_going = false;  ///< said aloud
  std::string until;        ///< "06:00", local time; empty: no end
  bool library = false;     ///< of all datasets of the archive
  bool dry_run = false;
  bool explain = false;
  std::string dag;  ///< empty, "dot" or "json"
  bool verify = false;
};

/// Binds the options of `run` to `options`, which must live until the command line is parsed.
void add_run_options(CLI::App* command, RunOptions& options);

/// Those of them that are about jobs of any kind: limits, executors, what is told.
void add_job_options(CLI::App* command, RunOptions& options);

/// Turns the words that were given into parameters. Throws CLI::ValidationError on those that do
/// not go together.
void apply_words(RunOptions& options);

/// The options that datasets depend on, as --config reads them.
std::string config_text(const RunOptions& options);

}  // namespace semigeo::jobs::cli
