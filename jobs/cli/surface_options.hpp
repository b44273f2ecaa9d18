#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "jobs/stages/surface_parameters.hpp"

namespace semigeo::jobs::cli {

/// The options for the datasets that are made.
struct SurfaceOptions {
  SurfaceParameters parameters;
  std::string tolerance;  ///< The text of --decimate; `complete` reads it.
};

/// Adds the options of surface_parameter_table() to a command. They are bound to `options`, which
/// must live until the command line is parsed.
void add_surface_options(CLI::App& command, SurfaceOptions& options);

/// Completes the parameters when the command line is parsed. Throws CLI::ValidationError if some of
/// them do not go together.
void complete(SurfaceOptions& options);

/// Returns the parameters as text of a configuration file, which --config reads.
std::string config_text(const SurfaceOptions& options);

}  // namespace semigeo::jobs::cli
