#include <cstdio>
#include <exception>
#include <memory>
#include <string>

#include "jobs/cli/command.hpp"

namespace {

/// Examples, kept as the footer, stand before everything else: what people come for.
class ExamplesFirst : public CLI::Formatter {
 public:
  std::string make_description(const CLI::App* app) const override {
    return app->get_footer() + "\n" + CLI::Formatter::make_description(app) + "\n";
  }
  std::string make_footer(const CLI::App*) const override { return ""; }
};

}  // namespace

int main(int argc, char** argv) {
  using namespace semigeo::jobs::cli;
  CLI::App app{"semigeo turns archives of 3-D scans into multi-scale surface datasets.", "semigeo"};
  app.formatter(std::make_shared<ExamplesFirst>());
  app.footer(
      "Examples:\n"
      "  semigeo run scans/ --output archive     every scan below scans/ gets a dataset\n"
      "  semigeo info archive                    what is in it\n"
      "  semigeo check archive                   is every byte as it was written?\n"
      "  semigeo export archive/scans/x.ply.vtkhdf --level 4 --output smooth.ply\n");
  app.set_version_flag("--version", SEMIGEO_VERSION);
  app.set_config("--config", "", "Read options from a TOML file like archive/semigeo.toml");
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
