#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace semigeo::jobs::cli {

// Each function returns a script with which a shell completes commands, options and values of the
// program. The scripts need nothing but the shell, and do not start the program.
std::string bash_completion(const CLI::App& program);
std::string zsh_completion(const CLI::App& program);
std::string fish_completion(const CLI::App& program);

}  // namespace semigeo::jobs::cli
