#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "jobs/archive/status.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/failures.hpp"
#include "jobs/cli/json_output.hpp"
#include "jobs/cli/output.hpp"
#include "jobs/kinds/given_names.hpp"
#include "jobs/run/progress.hpp"

namespace semigeo::jobs::cli {
namespace {

struct StatusOptions {
  std::string archive;
  bool json = false;
  bool details = false;  ///< Every failure and every repair is printed.
};

nlohmann::json to_json(const ArchiveStatus& status) {
  nlohmann::json document = {{"state", state_of(status)},
                             {"datasets", status.datasets},
                             {"damaged_journal_lines", status.damaged_lines}};
  if (status.owner)
    document["owner"] = {{"host", status.owner->process.host}, {"pid", status.owner->process.pid}};
  if (!status.last_run) return document;
  document["started"] = status.started;
  document["version"] = status.last_run->version;
  document["jobs"] = status.last_run->jobs;
  document["up_to_date"] = status.up_to_date;
  document["done"] = status.done;
  document["done_by_kind"] = status.done_by_kind;
  document["skipped"] = status.skipped;
  document["left"] = status.left();
  document["running"] = status.running;
  document["failed"] = status.failed;
  document["notes"] = status.notes;
  document["seconds"] = status.seconds;
  document["vertex_levels_per_second"] = status.vertex_levels_per_second();
  if (const auto left = status.seconds_left()) document["seconds_left"] = *left;
  return document;
}

/// Prints how many jobs have ended, and how fast.
void print_counts(const ArchiveStatus& status) {
  print(status.done, " done, ", status.up_to_date, " up to date, ", status.failed.size(),
        " failed, ", status.is_running() ? status.running.size() : 0, " running, ", status.left(),
        " left");
  if (status.skipped > 0) print(", ", status.skipped, " skipped");
  if (status.vertex_levels > 0)
    print("; ", short_number(status.vertex_levels_per_second()), " vertex levels/s");
  if (const auto left = status.seconds_left()) print(", ", short_duration(*left), " left");
  print("\n");
}

/// Returns how people know a job of the journal: its kind, and what they call its scan.
std::string shown_job(const std::string& job, const GivenNames& given) {
  const std::size_t name = job.find(' ') + 1;
  return job.substr(0, name) + given.name_of(job.substr(name));
}

void print_status(const ArchiveStatus& status, bool details, const GivenNames& given) {
  print(std::string_view(state_of(status)));
  if (status.last_run) print(", started ", status.started, ", ", short_duration(status.seconds));
  if (status.owner)
    print("; process ", status.owner->process.pid, " on ", status.owner->process.host);
  print("\n");
  if (status.last_run) print_counts(status);
  // If all jobs made datasets, the numbers above are enough.
  if (std::ranges::any_of(status.done_by_kind,
                          [](const auto& kind) { return kind.first != "surface"; }))
    for (const auto& [kind, number] : status.done_by_kind) print("done: ", number, " ", kind, "\n");
  for (const auto& [job, seconds] : status.running)
    print(std::string_view(status.is_running() ? "running" : "cut off"), ": ",
          shown_job(job, given), ", since ", short_duration(seconds), "\n");
  if (details || status.failed.size() <= kFew) {
    for (const auto& [job, error] : status.failed)
      print("failed: ", shown_job(job, given), ": ", error, "\n");
  } else {
    std::vector<Failure> failures;
    for (const auto& [job, error] : status.failed) failures.push_back({error});
    print_failures(failures);
  }
  if (details)
    for (const auto& [job, notes] : status.notes)
      for (const auto& [heading, text] : notes)
        print(heading, ": ", shown_job(job, given), ": ", text, "\n");
  print(status.datasets, " datasets in the archive\n");
}

}  // namespace

void add_status(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<StatusOptions>();
  CLI::App* command =
      app.add_subcommand("status", "Say how the last run of an archive stands, or stood");
  command->footer(
      "Examples:\n"
      "  semigeo status archive          done, failed and why, running, how fast, how much longer\n"
      "  semigeo status archive --details   every failure, and what was repaired and lost\n"
      "  semigeo status archive --json   the same for programs\n");
  command->add_option("archive", options->archive, "The archive")->required();
  command->add_flag("--details", options->details, "Name every failure, repair and loss");
  command->add_flag("--json", options->json, "As JSON");
  command->callback([options, &exit_code] {
    const ArchiveStatus status = status_of(options->archive);
    if (options->json) {
      print_document(to_json(status));
    } else {
      print_status(status, options->details,
                   GivenNames(std::filesystem::path(options->archive) / "library.h5"));
    }
    exit_code = kAllDone;
  });
}

}  // namespace semigeo::jobs::cli
