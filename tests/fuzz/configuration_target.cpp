// A configuration file: the options of datasets and of jobs, as --config reads them.
#include <CLI/CLI.hpp>

#include "io/files/error.hpp"
#include "io/files/small_file.hpp"
#include "jobs/cli/execution_options.hpp"
#include "jobs/cli/surface_options.hpp"
#include "tests/fuzz/target.hpp"

namespace semigeo::fuzz {
namespace {

struct Options {
  jobs::cli::SurfaceOptions surface;
  jobs::cli::ExecutionOptions execution;
};

/// Parses `semigeo --config FILE run`, whose options are those of jobs/cli/run.cpp. Returns whether
/// the file is one.
bool parse(const std::filesystem::path& file, Options& options) {
  CLI::App app{"fuzz", "semigeo"};
  app.set_config("--config", "", "FILE");
  app.allow_config_extras(CLI::config_extras_mode::error);
  app.require_subcommand(1);
  app.option_defaults()->always_capture_default();
  CLI::App* const command = app.add_subcommand("run");
  jobs::cli::add_surface_options(*command, options.surface);
  jobs::cli::add_execution_options(*command, options.execution);
  command->fallthrough();
  try {
    std::vector<std::string> arguments = {file.string(), "--config", "run"};  // last one first
    app.parse(arguments);
    jobs::cli::complete(options.surface);
    jobs::cli::complete(options.execution);
    return true;
  } catch (const std::exception&) {
    return false;  // the program prints it
  }
}

}  // namespace

void read_input(std::string_view bytes) {
  const std::filesystem::path file = write("semigeo.toml", bytes);
  Options options;
  if (!parse(file, options)) return;
  // What is written is read back to the same.
  const std::string text = jobs::cli::config_text(options.surface);
  Options again;
  check(parse(write("semigeo.toml", text), again), "a written configuration is refused");
  check(jobs::cli::config_text(again.surface) == text, "a configuration is not read back");
  check(jobs::to_json(again.surface.parameters) == jobs::to_json(options.surface.parameters),
        "parameters are not read back");
}

}  // namespace semigeo::fuzz
