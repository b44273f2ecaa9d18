#include <memory>
#include <nlohmann/json.hpp>

#include "jobs/archive/verification.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/datasets.hpp"
#include "jobs/cli/json_output.hpp"
#include "jobs/cli/output.hpp"

namespace semigeo::jobs::cli {
namespace {

struct CheckOptions {
  std::string target;
  bool json = false;
};

int check(const CheckOptions& options) {
  auto files = nlohmann::json::array();
  int broken = 0;
  const auto datasets = datasets_at(options.target);
  const auto problems = verify_datasets(datasets, 0);
  for (std::size_t i = 0; i < datasets.size(); ++i) {
    const std::string& problem = problems[i].problem;
    const bool ok = problem.empty();
    nlohmann::json entry = {{"file", datasets[i].string()}, {"ok", ok}};
    if (!ok) {
      ++broken;
      entry["error"] = problem;
      if (!options.json)
        print(std::string(problems[i].was_read ? "broken: " : "not read: "), problem, "\n");
    }
    files.push_back(std::move(entry));
  }
  if (options.json) {
    print_document({{"files", files}, {"broken", broken}});
  } else {
    print(files.size(), " checked, ", broken, " broken\n");
  }
  return broken == 0 ? kAllDone : kSomeFailed;
}

}  // namespace

void add_check(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = app.add_subcommand("check", "Read everything back and name what is broken");
  command->footer(
      "Examples:\n"
      "  semigeo check archive                    every dataset of an archive\n"
      "  semigeo check archive/scans/x.ply.vtkhdf\n"
      "\n"
      "Reads every array and compares checksums, the content digest and the rules of VTKHDF. "
      "Bytes\n"
      "that HDF5 keeps unused are not seen: they change no result. Exit code 1 if anything is\n"
      "broken; `semigeo run ... --verify` makes that again.\n");
  command->add_option("target", options->target, "A dataset, or an archive")->required();
  command->add_flag("--json", options->json, "As JSON");
  command->callback([options, &exit_code] { exit_code = check(*options); });
}

}  // namespace semigeo::jobs::cli
