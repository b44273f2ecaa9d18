#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "jobs/archive/links.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/failures.hpp"
#include "jobs/cli/json_output.hpp"
#include "jobs/cli/output.hpp"
#include "jobs/cli/report_pages.hpp"
#include "jobs/cli/run_plan.hpp"
#include "jobs/cli/temporary_folder.hpp"
#include "jobs/kinds/report.hpp"
#include "jobs/kinds/report_plan.hpp"

namespace semigeo::jobs::cli {
namespace {

namespace fs = std::filesystem;

struct ReportOptions {
  ReportPlace place;
  ExecutionOptions execution;
};

/// The numbers of pages of scans and scenes by what became of them.
struct PageCounts {
  std::int64_t made = 0;
  std::int64_t up_to_date = 0;
  std::int64_t failed = 0;
};

PageCounts count_pages(const RunResult& result) {
  PageCounts counts;
  for (std::size_t i = 0; i + 1 < result.plan.size(); ++i) {
    const JobState state = result.outcomes[i].state;
    counts.made += state == JobState::kDone ? 1 : 0;
    counts.up_to_date += state == JobState::kUpToDate ? 1 : 0;
    counts.failed += state == JobState::kFailed ? 1 : 0;
  }
  return counts;
}

/// Returns what the first page, which the last job of the plan makes, shows.
ReportJobResult shown_in(const RunResult& result) {
  const std::any& made = result.outcomes.back().result;
  if (const auto* counts = std::any_cast<ReportJobResult>(&made)) return *counts;
  if (!is_made(result.outcomes.back().state)) return {};
  return shown_on_first_page(result.plan.back().job.output);
}

void print_report(const RunResult& result, const ReportOptions& options) {
  const PageCounts counts = count_pages(result);
  const ReportJobResult shown = shown_in(result);
  const fs::path& index = result.plan.back().job.output;
  if (options.execution.json) {
    nlohmann::json document = {{"report", index.string()},
                               {"scans", shown.scans},
                               {"failures", shown.failures},
                               {"pages_made", counts.made},
                               {"pages_up_to_date", counts.up_to_date},
                               {"pages_failed", counts.failed}};
    if (!result.stopped.empty()) document["stopped"] = result.stopped;
    print_document(document);
    return;
  }
  const bool told = !options.execution.quiet && outputs_are_one_place();
  print_failures(failures_of(result), told);
  print_stop(result, told);
  print(index, "\nscans: ", shown.scans, ", failures: ", shown.failures,
        "; pages of scans and scenes: ", counts.made, " made, ", counts.up_to_date, " up to date",
        counts.failed > 0 ? ", " + std::to_string(counts.failed) + " failed" : "", "\n");
}

/// Makes the report. It takes no lock and writes no journal, so that it can be made while a run is
/// under way, and of an archive that cannot be written.
int report(ReportOptions& options) {
  if (lacks_pages()) return kUsage;
  const TemporaryFolder temporary;
  ReportPlace& place = options.place;
  place.archive = fs::absolute(place.archive).lexically_normal();
  if (place.folder.empty()) {
    place.folder = report_folder(place.archive);
    refuse_links(place.archive);
  }
  place.folder = fs::absolute(place.folder).lexically_normal();
  return run_plan(options.execution,
                  {.home = temporary.path(),
                   .plan =
                       [&](DigestCache&) {
                         std::vector<PlannedJob> plan;
                         DigestCache cache = DigestCache::read(place.archive);
                         plan_report(plan, models_of(place.archive, {}, cache), place);
                         return plan;
                       },
                   .is_archive = false,
                   .is_kept = false,
                   .print = [&](const RunResult& result) { print_report(result, options); }});
}

}  // namespace

void add_report(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command =
      app.add_subcommand("report", "Make pages for a browser of what an archive holds");
  command->footer(
      "Examples:\n"
      "  semigeo report archive                  archive/report/index.html, a page for each scan\n"
      "                                          and each recognised scene\n"
      "  semigeo report archive --output pages   pages/index.html, pages/scans/*.html, ...\n"
      "  semigeo report archive --index-only     the table of all scans alone\n"
      "\n"
      "The pages open by double click, need no network and can be mailed. A page of a scan takes\n"
      "up to 6 MB; one that shows what the dataset holds is left as it is. Exit codes: 0 done,\n"
      "1 something cannot be read or written, 2 usage, or this program was built without the\n"
      "report, 75 stopped early.\n");
  command->add_option("archive", options->place.archive, "The archive")
      ->required()
      ->configurable(false);
  command
      ->add_option("-o,--output", options->place.folder,
                   "Folder of the pages; without it, ARCHIVE/report")
      ->default_str("")
      ->configurable(false);
  command->add_flag("--index-only", options->place.index_only, "Make no pages of single scans");
  add_execution_options(*command, options->execution);
  command->fallthrough();
  command->callback([options, &exit_code] {
    complete(options->execution);
    if (options->execution.executor == ExecutorKind::kSlurm)
      throw CLI::ValidationError("--executor",
                                 "a report is made here; on a cluster, use semigeo run --report");
    exit_code = report(*options);
  });
}

}  // namespace semigeo::jobs::cli
