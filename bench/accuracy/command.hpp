#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "kernels/evolution/evolution.hpp"

namespace semigeo::accuracy {

/// Exit codes of both commands.
inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;
inline constexpr int kUsage = 2;

/// A command's options are bound when it is added; when the command line names it, it stores its
/// exit code.
void add_directions(CLI::App& app, int& exit_code);
void add_analytic(CLI::App& app, int& exit_code);

inline kernels::Coordinates coordinates_of(const std::string& name) {
  return name == "polar" ? kernels::Coordinates::kPolar : kernels::Coordinates::kSemigeodesic;
}

}  // namespace semigeo::accuracy
