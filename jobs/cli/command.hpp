#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

namespace semigeo::jobs::cli {

// The exit codes of every command.
inline constexpr int kAllDone = 0;        ///< All jobs are done, or were up to date.
inline constexpr int kSomeFailed = 1;     ///< Some jobs have failed.
inline constexpr int kUsage = 2;          ///< The command line is wrong.
inline constexpr int kLocked = 73;        ///< Another run has the archive.
inline constexpr int kStoppedEarly = 75;  ///< The run was stopped before all jobs had ended.

// Each function adds a command and its options. When the command line names the command, it runs
// and stores its exit code.
void add_run(CLI::App& app, int& exit_code);
void add_job(CLI::App& app, int& exit_code);
void add_status(CLI::App& app, int& exit_code);
void add_library(CLI::App& app, int& exit_code);
void add_recognise(CLI::App& app, int& exit_code);
void add_info(CLI::App& app, int& exit_code);
void add_check(CLI::App& app, int& exit_code);
void add_prune(CLI::App& app, int& exit_code);
void add_report(CLI::App& app, int& exit_code);
void add_picture(CLI::App& app, int& exit_code);
void add_export(CLI::App& app, int& exit_code);
void add_bench(CLI::App& app, int& exit_code);

/// Adds a hidden command that prints docs/options.md from the options that the other commands have.
void add_options_page(CLI::App& app);

}  // namespace semigeo::jobs::cli
