#include "jobs/cli/recognise_report.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "jobs/cli/json_output.hpp"
#include "jobs/cli/run_report.hpp"
#include "jobs/stages/recognised_file.hpp"

namespace semigeo::jobs::cli {
namespace {

using nlohmann::json;

constexpr int kNarrowestName = 12;

bool has_file(const JobOutcome& outcome) {
  return is_made(outcome.state);
}

std::string counted(std::size_t count, const char* one, const char* more) {
  return std::to_string(count) + " " + (count == 1 ? one : more);
}

double number(const json& object, const char* name) {
  return object.at(name).get<double>();
}

std::string name_of_model(const json& candidate) {
  return candidate.at("model").get<std::string>();
}

/// The layout of both tables of a scene.
struct Table {
  int width = 0;  ///< Width of the column of names.
  bool has_shares = true;
};

Table table_of(const json& document) {
  std::size_t width = kNarrowestName;
  for (const char* list : {"objects", "ranking"})
    for (const json& candidate : document.at(list))
      width = std::max(width, name_of_model(candidate).size());
  return {.width = static_cast<int>(width),
          .has_shares = document.at("search").at("method") != "thesis"};
}

void print_head(const char* what, int width) {
  std::printf("  %-10s %-*s %8s %7s %9s %10s %9s\n", what, width, "model", "score", "match",
              "conflict", "votes", "cluster");
}

/// Prints a row. The thesis' method compares no surfaces, so it has no matches and conflicts.
void print_row(std::size_t place, const json& candidate, const Table& table) {
  const auto share = [&](const char* name) {
    char text[32] = "-";
    if (table.has_shares) std::snprintf(text, sizeof text, "%.3f", number(candidate, name));
    return std::string(text);
  };
  std::printf("  %10zu %-*s %8.4g %7s %9s %10.2f %9.2f\n", place, table.width,
              name_of_model(candidate).c_str(), number(candidate, "score"), share("match").c_str(),
              share("conflict").c_str(), number(candidate, "votes"), number(candidate, "cluster"));
}

/// Prints a pose as a 4 x 4 matrix, and as the seven numbers of the thesis.
void print_pose(const json& pose) {
  constexpr int kIndent = 13;
  std::printf("%*sscale %.6g; d h q %.6g %.6g %.6g; gamma beta alpha %.3f %.3f %.3f degrees\n",
              kIndent, "", number(pose, "scale"), number(pose, "d"), number(pose, "h"),
              number(pose, "q"), number(pose, "gamma_degrees"), number(pose, "beta_degrees"),
              number(pose, "alpha_degrees"));
  for (const json& row : pose.at("matrix"))
    std::printf("%*s%13.6g %13.6g %13.6g %13.6g\n", kIndent, "", row.at(0).get<double>(),
                row.at(1).get<double>(), row.at(2).get<double>(), row.at(3).get<double>());
}

std::string verdict(const json& document) {
  const json& objects = document.at("objects");
  if (!objects.empty()) return counted(objects.size(), "object", "objects");
  if (document.at("scene").at("features") == 0) return "no features: nothing can be recognised";
  std::string text = "no model of the library is in this scene";
  char least[32];
  std::snprintf(least, sizeof least, "%.4g", number(document.at("search"), "min_score"));
  const json& ranking = document.at("ranking");
  return text + (ranking.empty() ? " (nothing agrees with any)"
                                 : std::string(" (no score reaches ") + least + ")");
}

void print_scene(const PlannedJob& planned, const json& document, std::size_t top) {
  std::printf("%s: %s\n", planned.job.input.c_str(), verdict(document).c_str());
  const Table table = table_of(document);
  std::size_t place = 0;
  for (const json& object : document.at("objects")) {
    if (place == 0) print_head("object", table.width);
    print_row(++place, object, table);
    print_pose(object.at("pose"));
  }
  place = 0;
  for (const json& candidate : document.at("ranking")) {
    if (place == top) break;
    if (place == 0) print_head("ranking", table.width);
    print_row(++place, candidate, table);
  }
  std::printf("\n");
}

}  // namespace

void print_recognised(const RunResult& result, const SearchedLibrary& library,
                      const RecogniseReport& report) {
  const auto& [plan, outcomes, summary] = result;
  std::size_t found = 0;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    if (!has_file(outcomes[i])) continue;
    const json document = read_recognised(plan[i].job.output);
    found += document.at("objects").empty() ? 0 : 1;
    print_scene(plan[i], document, report.top);
  }
  for (const JobOutcome& outcome : outcomes)
    if (outcome.state == JobState::kFailed) std::printf("failed: %s\n", outcome.error.c_str());
  print_passed_over(report.passed_over);
  const auto done = static_cast<std::size_t>(std::ranges::count_if(outcomes, has_file));
  std::printf(
      "%s, %s: %zu with objects, %zu without, %lld failed%s; %.2f s wall, %.2f s CPU, "
      "%.0f MB peak\n",
      counted(plan.size(), "scene", "scenes").c_str(),
      counted(library.models, "model", "models").c_str(), found, done - found,
      static_cast<long long>(summary.failed),
      summary.not_run > 0 ? (", " + std::to_string(summary.not_run) + " not run").c_str() : "",
      summary.wall_seconds, summary.cpu_seconds, summary.peak_bytes / 1e6);
}

void print_recognised_json(const RunResult& result, const SearchedLibrary& library,
                           const RecogniseReport& report) {
  const auto& [plan, outcomes, summary] = result;
  json document = {{"scenes", json::array()},
                   {"library", {{"path", library.path.string()}, {"digest", library.digest}}},
                   {"done", summary.done},
                   {"up_to_date", summary.up_to_date},
                   {"failed", summary.failed},
                   {"not_run", summary.not_run},
                   {"wall_seconds", summary.wall_seconds},
                   {"cpu_seconds", summary.cpu_seconds},
                   {"peak_memory_bytes", summary.peak_bytes}};
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
      scene["recognised"] = std::move(content);
    }
    document["scenes"].push_back(std::move(scene));
  }
  add_passed_over(document, report.passed_over);
  print_document(document);
}

}  // namespace semigeo::jobs::cli
