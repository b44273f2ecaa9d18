#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "engine/run_command.hpp"
#include "jobs/bench/cases.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

/// Memory must move at least so many bytes for each vertex and level of a job.
constexpr double kJobBytes = 1000;

/// Runs `semigeo run` as a user does.
BenchWork run_program(const fs::path& program, const fs::path& scans, const fs::path& archive,
                      int threads) {
  const engine::CommandResult result =
      engine::run_command({program.string(), "run", scans.string(), "--output", archive.string(),
                           "--threads", std::to_string(threads), "--json"},
                          {.seconds = 600});
  const std::size_t begin = result.text.find('{');
  if (result.exit_code != 0 || begin == std::string::npos)
    throw std::runtime_error("`semigeo run " + scans.string() + "` failed: " + result.text);
  const nlohmann::json document = nlohmann::json::parse(result.text.substr(begin));
  const double vertex_levels = document.at("vertex_levels");
  return {.amount = document.at("done"),
          .vertex_levels = vertex_levels,
          .memory_bytes = kJobBytes * vertex_levels};
}

struct NamedScans {
  const char* name;
  const fs::path& (BenchInputs::*scans)();
};
constexpr NamedScans kScans[] = {{"job/small", &BenchInputs::small_folder},
                                 {"job/large", &BenchInputs::large_file},
                                 {"job/scan", &BenchInputs::scan_file}};

}  // namespace

void add_job_cases(std::vector<BenchCase>& cases, const BenchInputsPointer& inputs,
                   const std::vector<int>& threads) {
  const fs::path archive = inputs->folder() / "archive";
  for (const NamedScans& named : kScans)
    for (const int count : threads)
      cases.push_back({.name = named.name,
                       .unit = "scans/s",
                       .threads = count,
                       .run =
                           [=](engine::Workers&) {
                             return run_program(inputs->program(), (*inputs.*named.scans)(),
                                                archive, count);
                           },
                       .prepare =
                           [=](engine::Workers&) {
                             (*inputs.*named.scans)();
                             fs::remove_all(archive);
                           },
                       .in_children = true});
}

}  // namespace semigeo::jobs
