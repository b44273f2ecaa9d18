#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "jobs/cli/conventions.hpp"

namespace semigeo::jobs::cli {

// Each function adds a command and its options. When the command line names the command, it runs
// and stores its exit code.
void add_run(CLI::App& app, int& exit_code);
void add_job(CLI::App& app, int& exit_code);
void add_status(CLI::App& app, int& exit_code);
void add_library(CLI::App& app, int& exit_code);
void add_recognise(CLI::App& app, int& exit_code);
void add_similar(CLI::App& app, int& exit_code);
void add_info(CLI::App& app, int& exit_code);
void add_check(CLI::App& app, int& exit_code);
void add_prune(CLI::App& app, int& exit_code);
void add_report(CLI::App& app, int& exit_code);
void add_picture(CLI::App& app, int& exit_code);
void add_export(CLI::App& app, int& exit_code);
void add_formats(CLI::App& app, int& exit_code);
void add_bench(CLI::App& app, int& exit_code);

/// Adds a hidden command that prints docs/options.md from the options that the other commands have.
void add_options_page(CLI::App& app);
/// Adds a hidden command that writes man pages and completions of shells, made from the options
/// that the other commands have.
void add_system_files(CLI::App& app);

}  // namespace semigeo::jobs::cli
