// How accurate the curvature is: against surfaces whose curvature is known, and against itself in
// other directions.
#include <cstdio>
#include <exception>
#include <memory>

#include "bench/accuracy/command.hpp"
#include "bench/support/examples_first.hpp"

int main(int argc, char** argv) {
  using namespace semigeo::accuracy;
  CLI::App app{"How accurate semigeo's curvature is.", "accuracy"};
  app.formatter(std::make_shared<semigeo::bench::ExamplesFirst>());
  app.footer(
      "Examples:\n"
      "  accuracy analytic                           errors where the curvature is known\n"
      "  accuracy directions scan.ply --output out   does the first direction matter?\n");
  app.require_subcommand(1);
  app.option_defaults()->always_capture_default();
  int exit_code = kDone;
  add_directions(app, exit_code);
  add_analytic(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? kDone : kUsage;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "accuracy: %s\n", e.what());
    return kFailed;
  }
  return exit_code;
}
