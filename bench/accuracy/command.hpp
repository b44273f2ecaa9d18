#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "kernels/evolution/evolution.hpp"

namespace semigeo::accuracy {

/// Exit codes of both commands.
inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;
inline constexpr int kUsage = 2;

// Each function adds a command and its options. When the command line names the command, it runs
// and stores its exit code.
void add_directions(CLI::App& app, int& exit_code);
void add_analytic(CLI::App& app, int& exit_code);

/// Returns the coordinates that an option names: "polar", or anything else for semigeodesic ones.
inline kernels::Coordinates coordinates_of(const std::string& name) {
  return name == "polar" ? kernels::Coordinates::kPolar : kernels::Coordinates::kSemigeodesic;
}

}  // namespace semigeo::accuracy
