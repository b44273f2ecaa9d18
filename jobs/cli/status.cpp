#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "jobs/archive/status.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/json_output.hpp"
#include "jobs/run/progress.hpp"

namespace semigeo::jobs::cli {
namespace {

struct StatusOptions {
  std::string archive;
  bool json = false;
};

/// Returns the state of the last run in one or two words.
const char* state_of(const ArchiveStatus& status) {
  if (!status.last_run) return status.owner ? "starting" : "never run";
  if (status.is_running()) return "running";
  if (!status.ended) return "interrupted";
  return status.left() > 0 ? "stopped early" : "ended";
}

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
  document["seconds"] = status.seconds;
  document["vertex_levels_per_second"] = status.vertex_levels_per_second();
  if (const auto left = status.seconds_left()) document["seconds_left"] = *left;
  return document;
}

void print(const ArchiveStatus& status) {
  const auto count = [](auto number) { return static_cast<long long>(number); };
  std::printf("%s", state_of(status));
  if (status.last_run)
    std::printf(", started %s, %s", status.started.c_str(), short_duration(status.seconds).c_str());
  if (status.owner)
    std::printf("; process %lld on %s", count(status.owner->process.pid),
                status.owner->process.host.c_str());
  std::printf("\n");
  if (status.last_run) {
    std::printf("%lld done, %lld up to date, %lld failed, %lld running, %lld left",
                count(status.done), count(status.up_to_date), count(status.failed.size()),
                count(status.is_running() ? status.running.size() : 0), count(status.left()));
    if (status.skipped > 0) std::printf(", %lld skipped", count(status.skipped));
    if (status.vertex_levels > 0)
      std::printf("; %s vertex levels/s", short_number(status.vertex_levels_per_second()).c_str());
    if (const auto left = status.seconds_left())
      std::printf(", %s left", short_duration(*left).c_str());
    std::printf("\n");
  }
  // If all jobs made datasets, the numbers above are enough.
  if (std::ranges::any_of(status.done_by_kind,
                          [](const auto& kind) { return kind.first != "surface"; }))
    for (const auto& [kind, number] : status.done_by_kind)
      std::printf("done: %lld %s\n", count(number), kind.c_str());
  for (const auto& [job, seconds] : status.running)
    std::printf("%s: %s, since %s\n", status.is_running() ? "running" : "cut off", job.c_str(),
                short_duration(seconds).c_str());
  for (const auto& [job, error] : status.failed)
    std::printf("failed: %s: %s\n", job.c_str(), error.c_str());
  std::printf("%lld datasets in the archive\n", count(status.datasets));
}

}  // namespace

void add_status(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<StatusOptions>();
  CLI::App* command =
      app.add_subcommand("status", "Say how the last run of an archive stands, or stood");
  command->footer(
      "Examples:\n"
      "  semigeo status archive          done, failed and why, running, how fast, how much longer\n"
      "  semigeo status archive --json   the same for programs\n");
  command->add_option("archive", options->archive, "The archive")->required();
  command->add_flag("--json", options->json, "As JSON");
  command->callback([options, &exit_code] {
    const ArchiveStatus status = status_of(options->archive);
    options->json ? print_document(to_json(status)) : print(status);
    exit_code = kAllDone;
  });
}

}  // namespace semigeo::jobs::cli
