#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "jobs/cli/option_tree.hpp"

namespace semigeo::jobs::cli {

/// Returns the man page of the program, semigeo(1): commands, exit codes and environment.
std::string program_manual(const CLI::App& program);

/// Returns the man page of a command, such as semigeo-run(1): its options and examples.
std::string command_manual(const ShownCommand& command);

/// Returns the name of a command's man page: "semigeo-library-build".
std::string manual_name(const ShownCommand& command);

}  // namespace semigeo::jobs::cli
