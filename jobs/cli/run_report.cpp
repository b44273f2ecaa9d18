#include "jobs/cli/run_report.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "jobs/cli/json_output.hpp"
#include "jobs/plan/library_plan.hpp"

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

/// Of a surface job what was done to a scan; of another its kind.
nlohmann::json job_json(const PlannedJob& planned) {
  nlohmann::json scan = {{"name", planned.job.name},
                         {"input", planned.job.input.string()},
                         {"output", planned.job.output.string()}};
  for (const Reason& reason : planned.reasons) scan["reasons"].push_back(reason_json(reason));
  if (planned.job.kind != JobKind::kSurface) scan["kind"] = name_of(planned.job.kind);
  return scan;
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

const SurfaceJobResult* surface_result(const JobOutcome& outcome) {
  return std::get_if<SurfaceJobResult>(&outcome.result);
}

/// The lists of a document: `jobs` is there only if there are jobs of other kinds.
void add_to(nlohmann::json& document, const PlannedJob& planned, nlohmann::json&& entry) {
  document[planned.job.kind == JobKind::kSurface ? "scans" : "jobs"].push_back(std::move(entry));
}

void add_result(nlohmann::json& entry, const SurfaceJobResult& result,
                const SurfaceParameters& parameters) {
  entry["format"] = result.format;
  entry["vertices"] = result.vertices;
  entry["triangles"] = result.triangles;
  entry["parts"] = result.parts;
  entry["levels"] = result.levels;
  entry["repairs"] = json_of(result.repairs);
  entry["preparation"] = json_of(result.preparation, parameters.preparation);
  entry["vanished"] = result.vanished;
  entry["remeshing"] = json_of(result.remeshed);
}

bool is_made(JobState state) {
  return state == JobState::kDone || state == JobState::kUpToDate;
}

nlohmann::json library_json(const Job& library, JobState state) {
  const auto missing = missing_models(library);
  return {{"output", library.output.string()},
          {"state", name_of(state)},
          {"models", library.models.size() - missing.size()},
          {"missing", missing}};
}

void print_library(const Job& library, JobState state) {
  const auto missing = missing_models(library);
  if (is_made(state)) {
    std::printf("library: %s: %zu models%s", library.output.c_str(),
                library.models.size() - missing.size(),
                state == JobState::kUpToDate ? ", up to date" : "");
  } else {
    std::printf("library: %s: %s", library.output.c_str(), std::string(name_of(state)).c_str());
  }
  for (std::size_t i = 0; is_made(state) && i < missing.size(); ++i)
    std::printf("%s%s", i == 0 ? "; missing: " : ", ", missing[i].c_str());
  std::printf("\n");
}

const char* what_of(const PlannedJob& planned) {
  if (planned.job.kind == JobKind::kRecognise) return "scenes";
  return planned.job.kind == JobKind::kSurface ? "scans" : "jobs of a library";
}

/// "5 scans: 3 would run, 2 up to date".
void print_counts(const std::vector<const PlannedJob*>& plan) {
  const auto up_to_date = std::ranges::count_if(plan, &PlannedJob::up_to_date);
  const auto unreadable =
      std::ranges::count_if(plan, [](const PlannedJob* planned) { return !is_readable(*planned); });
  const auto all = static_cast<long long>(plan.size());
  std::printf("%lld %s: %lld would run, %lld up to date", all, what_of(*plan.front()),
              all - up_to_date - unreadable, static_cast<long long>(up_to_date));
  if (unreadable > 0) std::printf(", %lld cannot be read", static_cast<long long>(unreadable));
  std::printf("\n");
}

}  // namespace

void print_plan(const std::vector<PlannedJob>& plan, bool json, bool explain) {
  if (json) {
    nlohmann::json document = {{"scans", nlohmann::json::array()}};
    for (const PlannedJob& p : plan) {
      auto entry = job_json(p);
      entry["state"] = state_of(p);
      if (!p.reasons.empty()) entry["reason"] = in_short(p.reasons);
      if (!p.error.empty()) entry["error"] = p.error;
      add_to(document, p, std::move(entry));
    }
    print_document(document);
    return;
  }
  std::vector<const PlannedJob*> scans;
  std::vector<const PlannedJob*> others;
  for (const PlannedJob& p : plan) {
    const bool of_scan = p.job.kind == JobKind::kSurface;
    (of_scan ? scans : others).push_back(&p);
    if (p.up_to_date) continue;
    std::printf("%s: %s\n", (of_scan ? p.job.name : job_id(p.job)).c_str(),
                p.error.empty() ? ("would run: " + in_short(p.reasons)).c_str() : p.error.c_str());
    if (!explain) continue;
    for (const Reason& reason : p.reasons) std::printf("    %s\n", in_words(reason).c_str());
  }
  if (!scans.empty()) print_counts(scans);
  if (!others.empty()) print_counts(others);
}

void print_json(const std::vector<PlannedJob>& plan, const std::vector<JobOutcome>& outcomes,
                const SurfaceParameters& parameters, const RunSummary& summary) {
  nlohmann::json document = {{"scans", nlohmann::json::array()},
                             {"done", summary.done},
                             {"up_to_date", summary.up_to_date},
                             {"failed", summary.failed},
                             {"skipped", summary.skipped},
                             {"not_run", summary.not_run},
                             {"vertex_levels", summary.vertex_levels},
                             {"vertex_levels_per_second", summary.rate()},
                             {"wall_seconds", summary.wall_seconds},
                             {"cpu_seconds", summary.cpu_seconds},
                             {"peak_memory_bytes", summary.peak_bytes}};
  for (std::size_t i = 0; i < plan.size(); ++i) {
    auto entry = job_json(plan[i]);
    const JobOutcome& outcome = outcomes[i];
    entry["state"] = name_of(outcome.state);
    entry["seconds"] = outcome.seconds;
    if (!outcome.error.empty()) entry["error"] = outcome.error;
    if (const auto* result = surface_result(outcome)) add_result(entry, *result, parameters);
    if (plan[i].job.kind == JobKind::kLibrary)
      document["library"] = library_json(plan[i].job, outcome.state);
    add_to(document, plan[i], std::move(entry));
  }
  print_document(document);
}

void print_text(const std::vector<PlannedJob>& plan, const std::vector<JobOutcome>& outcomes,
                const RunSummary& summary) {
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const auto* result = surface_result(outcomes[i]);
    if (result == nullptr || result->repairs == kernels::SurfaceRepairs{}) continue;
    std::string changes;
    const nlohmann::json repairs = json_of(result->repairs);
    for (const auto& [name, count] : repairs.items()) {
      if (count.get<std::int64_t>() == 0) continue;
      std::string words = name;
      std::replace(words.begin(), words.end(), '_', ' ');
      changes += (changes.empty() ? "" : ", ") + count.dump() + " " + words;
    }
    std::printf("repaired: %s: %s\n", plan[i].job.name.c_str(), changes.c_str());
  }
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const auto* result = surface_result(outcomes[i]);
    if (result == nullptr || result->preparation == PreparationResult{}) continue;
    std::printf("prepared: %s: %s\n", plan[i].job.name.c_str(),
                in_words(result->preparation).c_str());
  }
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const auto* result = surface_result(outcomes[i]);
    if (result == nullptr) continue;
    const std::string words = in_words(*result);
    if (!words.empty()) std::printf("evolved: %s: %s\n", plan[i].job.name.c_str(), words.c_str());
  }
  for (const JobOutcome& outcome : outcomes)
    if (outcome.state == JobState::kFailed) std::printf("failed: %s\n", outcome.error.c_str());
  for (std::size_t i = 0; i < plan.size(); ++i)
    if (plan[i].job.kind == JobKind::kLibrary) print_library(plan[i].job, outcomes[i].state);
  const std::string rate =
      summary.vertex_levels > 0 ? short_number(summary.rate()) + " vertex levels/s; " : "";
  const std::string not_run =
      (summary.skipped > 0 ? ", " + std::to_string(summary.skipped) + " skipped" : "") +
      (summary.not_run > 0 ? ", " + std::to_string(summary.not_run) + " not run" : "");
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
