#include <cstdio>
#include <exception>

#include "jobs/cli/command.hpp"

int main(int argc, char** argv) {
  using namespace semigeo::jobs::cli;
  CLI::App app{
      "Examples:\n"
      "  semigeo run scans/ --output archive     every scan below scans/ gets a dataset\n"
      "  semigeo info archive                    what is in it\n"
      "  semigeo check archive                   is every byte as it was written?\n"
      "  semigeo export archive/scans/x.ply.vtkhdf --level 4 --output smooth.ply\n"
      "\n"
      "semigeo turns archives of 3-D scans into multi-scale surface datasets.\n",
      "semigeo"};
  app.set_version_flag("--version", SEMIGEO_VERSION);
  app.set_config("--config", "", "Options from a TOML file, as archive/semigeo.toml has them");
  app.allow_config_extras(CLI::config_extras_mode::error);
  app.require_subcommand(1);
  app.option_defaults()->always_capture_default();
  int exit_code = kAllDone;
  add_run(app, exit_code);
  add_info(app, exit_code);
  add_check(app, exit_code);
  add_export(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? kAllDone : kUsage;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "semigeo: %s\n", e.what());
    return kSomeFailed;
  }
  return exit_code;
}
