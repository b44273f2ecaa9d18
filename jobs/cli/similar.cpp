#include <memory>
#include <string>

#include "jobs/cli/command.hpp"
#include "jobs/cli/failures.hpp"
#include "jobs/cli/search_run.hpp"
#include "jobs/cli/similar_report.hpp"
#include "jobs/stages/recognised_file.hpp"

namespace semigeo::jobs::cli {
namespace {

struct SimilarOptions {
  SearchRun run;
  SimilarReport report;
};

int find_similar(SimilarOptions& options) {
  options.run.search.resemblance = true;
  return run_search(options.run, [&](const RunResult& result, const Searched& searched) {
    const ExecutionOptions& execution = options.run.execution;
    options.report.failures_were_told = !execution.quiet && outputs_are_one_place();
    (execution.json ? print_similar_json : print_similar)(result, searched, options.report);
  });
}

void add_options(CLI::App* command, SimilarOptions& options) {
  add_search_places(*command, "scans", options.run);
  command
      ->add_option("--top", options.report.top,
                   "Models to print for each scan; " + std::to_string(kMostResembling) + " at most")
      ->check(CLI::Range(std::size_t{0}, kMostResembling));
  command->add_flag("--groups", options.report.groups,
                    "Print which scans and models are of one object, as groups");
  command
      ->add_option("--min-score", options.run.min_score,
                   "A part with less is not taken to be of one object")
      ->default_str("");
  add_execution_options(*command, options.run.execution);
}

}  // namespace

void add_similar(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<SimilarOptions>();
  CLI::App* command = app.add_subcommand(
      "similar", "Say which models of a library resemble a scan, as a whole or in a part");
  command->footer(
      "Examples:\n"
      "  semigeo similar vase.ply --library archive         what else is of this kind?\n"
      "  semigeo similar archive --library archive --groups --output found\n"
      "                                                     which scans are of one object?\n"
      "\n"
      "whole: how alike both surfaces are, whatever their size: 1 the same, 0.95 two scans of one\n"
      "object, 0.85 things of one kind, below 0.8 anything. part: the score of recognition, if\n"
      "parts of both surfaces lie on each other. A dataset that is a model is not compared with\n"
      "itself. Exit codes are those of semigeo recognise.\n");
  add_options(command, *options);
  command->fallthrough();
  command->callback([options, &exit_code] {
    complete(options->run);
    exit_code = find_similar(*options);
  });
}

}  // namespace semigeo::jobs::cli
