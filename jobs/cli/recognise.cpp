#include <memory>
#include <string>

#include "jobs/cli/command.hpp"
#include "jobs/cli/failures.hpp"
#include "jobs/cli/recognise_report.hpp"
#include "jobs/cli/search_run.hpp"
#include "jobs/cli/table_options.hpp"
#include "jobs/stages/recognised_file.hpp"

namespace semigeo::jobs::cli {
namespace {

struct RecogniseOptions {
  SearchRun run;
  std::size_t top = RecogniseReport{}.top;
};

int recognise(RecogniseOptions& options) {
  return run_search(options.run, [&](const RunResult& result, const Searched& searched) {
    const ExecutionOptions& execution = options.run.execution;
    const RecogniseReport report = {
        .top = options.top,
        .failures_were_told = !execution.quiet && outputs_are_one_place(),
        .has_files = searched.has_files,
        .passed_over = searched.passed_over};
    (execution.json ? print_recognised_json : print_recognised)(result, searched.library, report);
  });
}

void add_options(CLI::App* command, RecogniseOptions& options) {
  add_search_places(*command, "scenes", options.run);
  add_table_options(*command, search_parameter_table(), options.run.search);
  command
      ->add_option("--min-score", options.run.min_score,
                   "A model with less is not in the scene; 0 names the best, whatever it is")
      ->default_str("");
  command
      ->add_option("--top", options.top,
                   "Models of the ranking to print; " + std::to_string(kMostRanked) + " at most")
      ->check(CLI::Range(std::size_t{0}, kMostRanked));
  add_execution_options(*command, options.run.execution);
}

}  // namespace

void add_recognise(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RecogniseOptions>();
  CLI::App* command =
      app.add_subcommand("recognise", "Say which models of a library are in a scene, and where");
  command->alias("recognize");
  command->footer(
      "Examples:\n"
      "  semigeo recognise scene.ply --library archive      in archive/library.h5\n"
      "  semigeo recognise scenes/ --library mine.h5 --output found\n"
      "                                                     keeps found/recognised/<scene>.json\n"
      "  semigeo recognise scene.ply --library mine.h5 --json --top 20\n"
      "\n"
      "A pose leads from the model's coordinates to the scene's, in the units of their files: a\n"
      "4 x 4 matrix for column vectors; and scale, translation d h q and angles gamma beta alpha\n"
      "with R = Rz(alpha) Ry(beta) Rx(gamma). Exit codes: 0 all scenes were looked at, whether or\n"
      "not something is in them, 1 some failed, 2 usage, 73 another run has the folder, 75 "
      "stopped\n"
      "early: run again to go on.\n");
  add_options(command, *options);
  command->fallthrough();
  command->callback([options, &exit_code] {
    complete(options->run);
    exit_code = recognise(*options);
  });
}

}  // namespace semigeo::jobs::cli
