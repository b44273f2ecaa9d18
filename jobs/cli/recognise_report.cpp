#include "jobs/cli/recognise_report.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "jobs/cli/failures.hpp"
#include "jobs/cli/json_output.hpp"
#include "jobs/cli/output.hpp"
#include "jobs/cli/run_report.hpp"
#include "jobs/kinds/given_names.hpp"
#include "jobs/run/progress.hpp"
#include "jobs/stages/recognised_file.hpp"

namespace semigeo::jobs::cli {
namespace {

using nlohmann::json;

bool has_file(const JobOutcome& outcome) {
  return is_made(outcome.state);
}

double number(const json& object, const char* name) {
  return object.at(name).get<double>();
}

std::string name_of_model(const json& candidate) {
  return candidate.at("model").get<std::string>();
}

using Rows = std::vector<std::vector<std::string>>;

constexpr std::size_t kIndent = 2;
constexpr std::string_view kAlignment = "rlrrrrr";

/// Returns a row. The thesis' method compares no surfaces, so it has no matches and conflicts.
std::vector<std::string> row_of(std::size_t place, const json& candidate, bool has_shares,
                                const GivenNames& given) {
  const auto share = [&](const char* name) {
    return has_shares ? io::fixed_text(number(candidate, name), 3) : std::string("-");
  };
  return {std::to_string(place),
          io::printable(given.shown(name_of_model(candidate))),
          io::fixed_text(number(candidate, "score"), 4),
          share("match"),
          share("conflict"),
          io::fixed_text(number(candidate, "votes"), 2),
          io::fixed_text(number(candidate, "cluster"), 2)};
}

/// Returns the lines of a table of the first `count` candidates: its head, and a line for each.
std::vector<std::string> table_of(const std::string& what, const json& candidates,
                                  std::size_t count, bool has_shares, const GivenNames& given) {
  Rows rows = {{what, "model", "score", "match", "conflict", "votes", "cluster"}};
  for (const json& candidate : candidates) {
    if (rows.size() > count) break;
    rows.push_back(row_of(rows.size(), candidate, has_shares, given));
  }
  std::istringstream text(table_text(rows, kIndent, kAlignment));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line + '\n');
  return lines;
}

/// Prints a pose as a 4 x 4 matrix, and as the seven numbers of the thesis.
void print_pose(const json& pose) {
  constexpr std::size_t kPoseIndent = 13;
  const auto real = [&](const char* name) { return io::number_text(number(pose, name)); };
  print(std::string(kPoseIndent, ' '), "scale ", real("scale"), "; d h q ", real("d"), " ",
        real("h"), " ", real("q"), "; gamma beta alpha ", real("gamma_degrees"), " ",
        real("beta_degrees"), " ", real("alpha_degrees"), " degrees\n");
  Rows rows;
  for (const json& row : pose.at("matrix")) {
    std::vector<std::string>& cells = rows.emplace_back();
    for (const json& value : row) cells.push_back(io::number_text(value.get<double>()));
  }
  print_text(table_text(rows, kPoseIndent, "rrrr"));
}

std::string verdict(const json& document) {
  const json& objects = document.at("objects");
  if (!objects.empty()) return counted(objects.size(), "object");
  if (document.at("scene").at("features") == 0) return "no features: nothing can be recognised";
  std::string text = "no model of the library is in this scene";
  const std::string least = io::number_text(number(document.at("search"), "min_score"));
  const json& ranking = document.at("ranking");
  return text + (ranking.empty() ? " (nothing agrees with any)"
                                 : std::string(" (no score reaches ") + least + ")");
}

void print_scene(const PlannedJob& planned, const json& document, std::size_t top,
                 const GivenNames& given) {
  print(planned.job.input, ": ", verdict(document), "\n");
  const bool has_shares = document.at("search").at("method") != "thesis";
  const json& objects = document.at("objects");
  if (!objects.empty()) {
    const std::vector<std::string> lines =
        table_of("object", objects, objects.size(), has_shares, given);
    print_text(lines.front());
    for (std::size_t i = 0; i < objects.size(); ++i) {
      print_text(lines[i + 1]);
      print_pose(objects[i].at("pose"));
    }
  }
  if (const json& ranking = document.at("ranking"); top > 0 && !ranking.empty())
    for (const std::string& line : table_of("ranking", ranking, top, has_shares, given))
      print_text(line);
  print("\n");
}

/// Adds to each candidate the scan that its model was made of, if it is known.
void add_scans(json& content, const GivenNames& given) {
  for (const char* list : {"objects", "ranking"})
    for (json& candidate : content.at(list))
      if (const auto scan = given.scan_of(name_of_model(candidate)); !scan.empty())
        candidate["scan"] = scan.string();
}

}  // namespace

void print_recognised(const RunResult& result, const SearchedLibrary& library,
                      const RecogniseReport& report) {
  const auto& plan = result.plan;
  const auto& outcomes = result.outcomes;
  const RunSummary& summary = result.summary;
  const GivenNames given(library.path);
  std::size_t found = 0;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    if (!has_file(outcomes[i])) continue;
    const json document = read_recognised(plan[i].job.output);
    found += document.at("objects").empty() ? 0 : 1;
    print_scene(plan[i], document, report.top, given);
  }
  print_failures(failures_of(result), report.failures_were_told);
  print_stop(result, report.failures_were_told);
  print_passed_over(report.passed_over);
  const auto done = static_cast<std::size_t>(std::ranges::count_if(outcomes, has_file));
  print(counted(plan.size(), "scene"), ", ", counted(library.models, "model"), ": ", found,
        " with objects, ", done - found, " without, ", summary.failed, " failed",
        summary.not_run > 0 ? ", " + std::to_string(summary.not_run) + " not run" : "", "; ",
        short_duration(summary.wall_seconds), " wall, ", short_duration(summary.cpu_seconds),
        " CPU, ", io::fixed_text(summary.peak_bytes / 1e6, 0), " MB peak\n");
}

json search_json(const RunResult& result, const SearchedLibrary& library) {
  const RunSummary& summary = result.summary;
  return {{"library", {{"path", library.path.string()}, {"digest", library.digest}}},
          {"done", summary.done},
          {"up_to_date", summary.up_to_date},
          {"failed", summary.failed},
          {"not_run", summary.not_run},
          {"wall_seconds", summary.wall_seconds},
          {"cpu_seconds", summary.cpu_seconds},
          {"peak_memory_bytes", summary.peak_bytes}};
}

void print_recognised_json(const RunResult& result, const SearchedLibrary& library,
                           const RecogniseReport& report) {
  const auto& plan = result.plan;
  const auto& outcomes = result.outcomes;
  const GivenNames given(library.path);
  json document = search_json(result, library);
  document["scenes"] = json::array();
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const JobOutcome& outcome = outcomes[i];
    json scene = {{"input", plan[i].job.input.string()}, {"state", name_of(outcome.state)}};
    if (!outcome.error.empty()) scene["error"] = outcome.error;
    if (has_file(outcome)) {
      if (report.has_files) scene["output"] = plan[i].job.output.string();
      json content = read_recognised(plan[i].job.output);
      json& ranking = content["ranking"];
      if (ranking.size() > report.top)
        ranking.erase(ranking.begin() + static_cast<std::ptrdiff_t>(report.top), ranking.end());
      add_scans(content, given);
      scene["recognised"] = std::move(content);
    }
    document["scenes"].push_back(std::move(scene));
  }
  add_passed_over(document, report.passed_over);
  if (!result.stopped.empty()) document["stopped"] = result.stopped;
  print_document(document);
}

}  // namespace semigeo::jobs::cli
