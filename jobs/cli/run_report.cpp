#include "jobs/cli/run_report.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "jobs/cli/json_output.hpp"

namespace semigeo::jobs::cli {
namespace {

/// Values of parameters are themselves; what there is not is null.
nlohmann::json reason_json(const Reason& reason) {
  const bool parameter = reason.kind == Reason::Kind::kParameter;
  const auto value = [&](const std::string& text) -> nlohmann::json {
    if (text.empty()) return nullptr;
    if (parameter) return nlohmann::json::parse(text, nullptr, false);
    return text;
  };
  nlohmann::json document = {{"kind", name_of(reason.kind)}};
  if (parameter) document["name"] = reason.parameter;
  if (parameter || !reason.before.empty()) document["before"] = value(reason.before);
  if (parameter || !reason.now.empty()) document["now"] = value(reason.now);
  return document;
}

nlohmann::json scan_json(const PlannedJob& planned) {
  nlohmann::json scan = {{"name", planned.job.name},
                         {"input", planned.job.input.string()},
                         {"output", planned.job.output.string()}};
  for (const Reason& reason : planned.reasons) scan["reasons"].push_back(reason_json(reason));
  return scan;
}

const char* state_name(JobState state) {
  switch (state) {
    case JobState::kDone:
      return "done";
    case JobState::kUpToDate:
      return "up to date";
    case JobState::kNotRun:
      return "not run";
    case JobState::kFailed:
      break;
  }
  return "failed";
}

std::string in_words(const PreparationResult& preparation) {
  const kernels::HoleCounts& holes = preparation.holes;
  std::string text;
  if (holes.loops > 0) {
    text = std::to_string(holes.filled) + " of " + std::to_string(holes.loops) + " holes filled";
    std::string left;
    const auto add = [&](std::int64_t count, const char* reason) {
      if (count > 0) left += (left.empty() ? "" : ", ") + std::to_string(count) + " " + reason;
    };
    add(holes.outer, "outer");
    add(holes.too_long, "too long");
    add(holes.unsplittable, "without a valid split");
    if (!left.empty()) text += " (left: " + left + ")";
  }
  if (preparation.removed_vertices > 0) {
    char distance[64];
    std::snprintf(distance, sizeof distance, "%.3g", preparation.distance.maximum);
    text += (text.empty() ? "" : ", ") + std::to_string(preparation.removed_vertices) +
            " vertices removed, at most " + distance + " from what is left";
  }
  return text.empty() ? "nothing to do" : text;
}

/// What became of a surface on its way through the levels, if it is worth a word.
std::string in_words(const SurfaceJobResult& result) {
  std::string text;
  const auto add = [&text](std::int64_t count, const char* one, const char* more) {
    if (count == 0) return;
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + (count == 1 ? one : more);
  };
  add(result.remeshed.torn, "neck torn", "necks torn");
  add(result.remeshed.dropped_parts, "part lost", "parts lost");
  if (result.vanished)
    text +=
        (text.empty() ? "" : "; ") + std::string("too thin for so many levels: it has vanished");
  return text;
}

}  // namespace

void print_plan(const std::vector<PlannedJob>& plan, bool json, bool explain) {
  if (json) {
    auto scans = nlohmann::json::array();
    for (const PlannedJob& p : plan) {
      auto scan = scan_json(p);
      scan["state"] = state_of(p);
      if (!p.reasons.empty()) scan["reason"] = in_short(p.reasons);
      if (!p.error.empty()) scan["error"] = p.error;
      scans.push_back(std::move(scan));
    }
    print_document({{"scans", scans}});
    return;
  }
  for (const PlannedJob& p : plan) {
    if (p.up_to_date) continue;
    std::printf("%s: %s\n", p.job.name.c_str(),
                p.error.empty() ? ("would run: " + in_short(p.reasons)).c_str() : p.error.c_str());
    if (!explain) continue;
    for (const Reason& reason : p.reasons) std::printf("    %s\n", in_words(reason).c_str());
  }
  const auto up_to_date = std::ranges::count_if(plan, &PlannedJob::up_to_date);
  const auto unreadable = std::ranges::count_if(plan, std::not_fn(is_readable));
  const auto all = static_cast<long long>(plan.size());
  std::printf("%lld scans: %lld would run, %lld up to date", all, all - up_to_date - unreadable,
              static_cast<long long>(up_to_date));
  if (unreadable > 0) std::printf(", %lld cannot be read", static_cast<long long>(unreadable));
  std::printf("\n");
}

void print_json(const std::vector<PlannedJob>& plan, const std::vector<JobOutcome>& outcomes,
                const SurfaceParameters& parameters, const RunSummary& summary) {
  auto scans = nlohmann::json::array();
  for (std::size_t i = 0; i < plan.size(); ++i) {
    auto scan = scan_json(plan[i]);
    const JobOutcome& outcome = outcomes[i];
    scan["state"] = state_name(outcome.state);
    scan["seconds"] = outcome.seconds;
    if (!outcome.error.empty()) scan["error"] = outcome.error;
    if (outcome.result) {
      scan["format"] = outcome.result->format;
      scan["vertices"] = outcome.result->vertices;
      scan["triangles"] = outcome.result->triangles;
      scan["parts"] = outcome.result->parts;
      scan["levels"] = outcome.result->levels;
      scan["repairs"] = nlohmann::json::parse(to_json(outcome.result->repairs));
      scan["preparation"] =
          nlohmann::json::parse(to_json(outcome.result->preparation, parameters.preparation));
      scan["vanished"] = outcome.result->vanished;
      scan["remeshing"] = nlohmann::json::parse(to_json(outcome.result->remeshed));
    }
    scans.push_back(std::move(scan));
  }
  const nlohmann::json document = {{"scans", scans},
                                   {"done", summary.done},
                                   {"up_to_date", summary.up_to_date},
                                   {"failed", summary.failed},
                                   {"not_run", summary.not_run},
                                   {"vertex_levels", summary.vertex_levels},
                                   {"vertex_levels_per_second", summary.rate()},
                                   {"wall_seconds", summary.wall_seconds},
                                   {"cpu_seconds", summary.cpu_seconds},
                                   {"peak_memory_bytes", summary.peak_bytes}};
  print_document(document);
}

void print_text(const std::vector<PlannedJob>& plan, const std::vector<JobOutcome>& outcomes,
                const RunSummary& summary) {
  for (std::size_t i = 0; i < plan.size(); ++i) {
    if (!outcomes[i].result || outcomes[i].result->repairs == kernels::SurfaceRepairs{}) continue;
    std::string changes;
    const auto repairs = nlohmann::json::parse(to_json(outcomes[i].result->repairs));
    for (const auto& [name, count] : repairs.items()) {
      if (count.get<std::int64_t>() == 0) continue;
      std::string words = name;
      std::replace(words.begin(), words.end(), '_', ' ');
      changes += (changes.empty() ? "" : ", ") + count.dump() + " " + words;
    }
    std::printf("repaired: %s: %s\n", plan[i].job.name.c_str(), changes.c_str());
  }
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const auto& result = outcomes[i].result;
    if (!result || result->preparation == PreparationResult{}) continue;
    std::printf("prepared: %s: %s\n", plan[i].job.name.c_str(),
                in_words(result->preparation).c_str());
  }
  for (std::size_t i = 0; i < plan.size(); ++i) {
    if (!outcomes[i].result) continue;
    const std::string words = in_words(*outcomes[i].result);
    if (!words.empty()) std::printf("evolved: %s: %s\n", plan[i].job.name.c_str(), words.c_str());
  }
  for (const JobOutcome& outcome : outcomes)
    if (outcome.state == JobState::kFailed) std::printf("failed: %s\n", outcome.error.c_str());
  const std::string rate =
      summary.vertex_levels > 0 ? short_number(summary.rate()) + " vertex levels/s; " : "";
  const std::string not_run =
      summary.not_run > 0 ? ", " + std::to_string(summary.not_run) + " not run" : "";
  std::printf("%lld done, %lld up to date, %lld failed%s; %s%s wall, %s CPU, %.0f MB peak\n",
              static_cast<long long>(summary.done), static_cast<long long>(summary.up_to_date),
              static_cast<long long>(summary.failed), not_run.c_str(), rate.c_str(),
              short_duration(summary.wall_seconds).c_str(),
              short_duration(summary.cpu_seconds).c_str(), summary.peak_bytes / 1e6);
}

void print_submitted(const std::vector<SubmittedStage>& stages, bool json) {
  nlohmann::json list = nlohmann::json::array();
  for (const SubmittedStage& stage : stages) {
    list.push_back({{"name", stage.name}, {"job", stage.job}, {"tasks", stage.tasks}});
    if (!json) std::printf("%s\n", stage.job.c_str());
  }
  if (json) std::printf("%s\n", nlohmann::json{{"submitted", list}}.dump(2).c_str());
}

}  // namespace semigeo::jobs::cli
