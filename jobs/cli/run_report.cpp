#include "jobs/cli/run_report.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "jobs/cli/failures.hpp"
#include "jobs/cli/json_output.hpp"
#include "jobs/cli/output.hpp"
#include "jobs/plan/job_kind.hpp"

namespace semigeo::jobs::cli {
namespace {

/// Returns a reason as JSON. A parameter always has both values; one that there was not is null.
nlohmann::json reason_json(const Reason& reason) {
  const bool parameter = reason.kind == Reason::Kind::kParameter;
  nlohmann::json document = {{"kind", name_of(reason.kind)}};
  if (parameter) document["name"] = reason.parameter;
  if (parameter || !reason.before.is_null()) document["before"] = reason.before;
  if (parameter || !reason.now.is_null()) document["now"] = reason.now;
  return document;
}

/// Names the job; jobs that do not stand for a scan also name their kind.
nlohmann::json job_json(const PlannedJob& planned) {
  nlohmann::json entry = {{"name", planned.job.name},
                          {"input", planned.job.input.string()},
                          {"output", planned.job.output.string()}};
  for (const Reason& reason : planned.reasons) entry["reasons"].push_back(reason_json(reason));
  const JobWords& words = planned.job.kind->words();
  if (!words.stands_for_scan) entry["kind"] = words.kind;
  return entry;
}

/// Adds to the lists of a document. `jobs` is there only if there are jobs that stand for no scan.
void add_to(nlohmann::json& document, const PlannedJob& planned, nlohmann::json&& entry) {
  const bool stands_for_scan = planned.job.kind->words().stands_for_scan;
  document[stands_for_scan ? "scans" : "jobs"].push_back(std::move(entry));
}

/// A line of the report about one job.
struct NamedLine {
  std::string name;  ///< Name of the job.
  ReportLine line;
};

/// Returns "1204 degenerate faces, 30 flipped faces and others": the sums over all lines, the
/// largest first.
std::string sums_of(const std::vector<NamedLine>& lines) {
  constexpr std::ptrdiff_t kMostSums = 3;
  std::map<std::string, std::int64_t> by_name;
  for (const NamedLine& named : lines)
    for (const auto& [name, count] : named.line.counts) by_name[name] += count;
  std::erase_if(by_name, [](const auto& sum) { return sum.second == 0; });
  std::vector<std::pair<std::string, std::int64_t>> sums(by_name.begin(), by_name.end());
  std::ranges::stable_sort(sums, std::ranges::greater(),
                           [](const auto& sum) { return sum.second; });
  std::string text;
  for (std::ptrdiff_t i = 0; i < std::min(std::ssize(sums), kMostSums); ++i)
    text += (i == 0 ? "" : ", ") + std::to_string(sums[static_cast<std::size_t>(i)].second) + " " +
            sums[static_cast<std::size_t>(i)].first;
  return text + (std::ssize(sums) > kMostSums ? " and others" : "");
}

/// Prints the lines of many jobs: their sums, and the names of those that have lost most.
void print_many(std::vector<NamedLine> lines, const std::string& plural) {
  constexpr std::size_t kMostNameCharacters = 24;
  print(lines.front().line.heading, ": ", lines.size(), " ", plural, ": ", sums_of(lines), "\n");
  std::erase_if(lines, [](const NamedLine& named) { return named.line.loss <= 0; });
  if (lines.empty()) return;
  std::ranges::stable_sort(lines, std::ranges::greater(),
                           [](const NamedLine& named) { return named.line.loss; });
  std::string worst = "  most: ";
  for (std::size_t i = 0; i < std::min(lines.size(), kFew); ++i) {
    const std::string name = io::printable(lines[i].name);
    const bool fits = io::count_characters(name) <= kMostNameCharacters;
    worst +=
        (i == 0 ? "" : ", ") +
        (fits ? name : std::string(io::first_characters(name, kMostNameCharacters - 3)) + "...");
  }
  print_text(worst + "\n");
}

/// Prints the reports of the jobs of one kind: the first lines of all jobs, then the second ones.
/// Returns whether something was left out.
bool print_reports(const RunResult& result, const JobKind& kind) {
  std::vector<std::vector<NamedLine>> lines;
  for (std::size_t i = 0; i < result.plan.size(); ++i) {
    const Job& job = result.plan[i].job;
    if (job.kind != &kind || !result.outcomes[i].result.has_value()) continue;
    const JobReport report = kind.report(job, result.outcomes[i].result);
    const std::string name = report.name.empty() ? job.name : report.name;
    lines.resize(std::max(lines.size(), report.lines.size()));
    for (std::size_t k = 0; k < report.lines.size(); ++k)
      if (!report.lines[k].text.empty()) lines[k].push_back({name, report.lines[k]});
  }
  bool shortened = false;
  for (const std::vector<NamedLine>& of_heading : lines) {
    if (of_heading.size() > kFew) {
      print_many(of_heading, kind.words().plural);
      shortened = true;
      continue;
    }
    for (const NamedLine& named : of_heading)
      print(named.line.heading, ": ", named.name, ": ", named.line.text, "\n");
  }
  return shortened;
}

/// Returns the kinds of a plan, in the order in which they appear.
std::vector<const JobKind*> kinds_of(const std::vector<PlannedJob>& plan) {
  std::vector<const JobKind*> kinds;
  for (const PlannedJob& planned : plan)
    if (std::ranges::find(kinds, planned.job.kind) == kinds.end())
      kinds.push_back(planned.job.kind);
  return kinds;
}

/// Prints "5 scans: 3 would run, 2 up to date".
void print_counts(const std::vector<const PlannedJob*>& plan) {
  const auto up_to_date = std::ranges::count_if(plan, &PlannedJob::up_to_date);
  const auto unreadable =
      std::ranges::count_if(plan, [](const PlannedJob* planned) { return !is_readable(*planned); });
  print(plan.size(), " ", plan.front()->job.kind->words().plural, ": ",
        std::ssize(plan) - up_to_date - unreadable, " would run, ", up_to_date, " up to date");
  if (unreadable > 0) print(", ", unreadable, " cannot be read");
  print("\n");
}

}  // namespace

void print_passed_over(const PassedOver& passed_over) {
  const std::string words = in_words(passed_over);
  for (const std::string& note : passed_over.notes) print("passed over: ", note, "\n");
  if (!words.empty()) print("passed over: ", words, "\n");
}

void add_passed_over(nlohmann::json& document, const PassedOver& passed_over) {
  if (!passed_over.files.empty()) document["passed_over"] = passed_over.files;
  if (!passed_over.notes.empty()) document["passed_over_notes"] = passed_over.notes;
}

namespace {

void print_notes(const RunNotes& notes) {
  print_passed_over(notes.passed_over);
  if (!notes.leftovers.text.empty()) print(notes.leftovers.text, "\n");
}

void add_notes(nlohmann::json& document, const RunNotes& notes) {
  add_passed_over(document, notes.passed_over);
  for (const auto& [name, value] : notes.leftovers.fields) document[name] = value;
}

}  // namespace

void print_stop(const RunResult& result, bool told) {
  if (!result.stopped.empty() && !told) print("stopped: ", result.stopped, "\n");
}

std::vector<Failure> failures_of(const RunResult& result) {
  std::vector<Failure> failures;
  for (std::size_t i = 0; i < result.plan.size(); ++i)
    if (result.outcomes[i].state == JobState::kFailed)
      failures.push_back({result.outcomes[i].error, subject_of(result.plan[i].job).string()});
  return failures;
}

void print_plan(const std::vector<PlannedJob>& plan, bool json, bool explain,
                const RunNotes& notes) {
  if (json) {
    nlohmann::json document = {{"scans", nlohmann::json::array()}};
    for (const PlannedJob& p : plan) {
      auto entry = job_json(p);
      entry["state"] = state_of(p);
      if (!p.reasons.empty()) entry["reason"] = in_short(p.reasons);
      if (!p.error.empty()) entry["error"] = p.error;
      add_to(document, p, std::move(entry));
    }
    add_notes(document, notes);
    print_document(document);
    return;
  }
  std::vector<const PlannedJob*> scans;
  std::vector<const PlannedJob*> others;
  for (const PlannedJob& p : plan) {
    const bool of_scan = p.job.kind->words().stands_for_scan;
    (of_scan ? scans : others).push_back(&p);
    if (p.up_to_date) continue;
    print(shown_name(p.job), ": ", p.error.empty() ? "would run: " + in_short(p.reasons) : p.error,
          "\n");
    if (!explain) continue;
    for (const Reason& reason : p.reasons) print("    ", in_words(reason), "\n");
  }
  print_notes(notes);
  if (!scans.empty()) print_counts(scans);
  if (!others.empty()) print_counts(others);
}

void print_json(const RunResult& result, const RunNotes& notes) {
  const RunSummary& summary = result.summary;
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
  add_notes(document, notes);
  if (!result.stopped.empty()) document["stopped"] = result.stopped;
  for (std::size_t i = 0; i < result.plan.size(); ++i) {
    const Job& job = result.plan[i].job;
    const JobOutcome& outcome = result.outcomes[i];
    auto entry = job_json(result.plan[i]);
    entry["state"] = name_of(outcome.state);
    entry["seconds"] = outcome.seconds;
    if (!outcome.error.empty()) entry["error"] = outcome.error;
    if (outcome.result.has_value())
      for (auto& [name, value] : job.kind->report(job, outcome.result).fields)
        entry[name] = std::move(value);
    if (auto told = job.kind->summary(job, outcome.state))
      for (auto& [name, value] : told->fields) document[name] = std::move(value);
    add_to(document, result.plan[i], std::move(entry));
  }
  print_document(document);
}

void print_run(const RunResult& result, const RunNotes& notes) {
  bool shortened = false;
  for (const JobKind* kind : kinds_of(result.plan)) shortened |= print_reports(result, *kind);
  shortened |= print_failures(failures_of(result), notes.failures_were_told);
  print_stop(result, notes.failures_were_told);
  for (std::size_t i = 0; i < result.plan.size(); ++i) {
    const Job& job = result.plan[i].job;
    if (const auto told = job.kind->summary(job, result.outcomes[i].state)) print(told->text, "\n");
  }
  print_notes(notes);
  if (shortened && !notes.home.empty())
    print("details: semigeo status ", shell_word(notes.home.string()), " --details\n");
  const RunSummary& summary = result.summary;
  const std::string rate =
      summary.vertex_levels > 0 ? short_number(summary.rate()) + " vertex levels/s; " : "";
  const std::string not_run =
      (summary.skipped > 0 ? ", " + std::to_string(summary.skipped) + " skipped" : "") +
      (summary.not_run > 0 ? ", " + std::to_string(summary.not_run) + " not run" : "");
  print(summary.done, " done, ", summary.up_to_date, " up to date, ", summary.failed, " failed",
        not_run, "; ", rate, short_duration(summary.wall_seconds), " wall, ",
        short_duration(summary.cpu_seconds), " CPU, ", io::fixed_text(summary.peak_bytes / 1e6, 0),
        " MB peak\n");
}

void print_submitted(const std::vector<SubmittedStage>& stages, bool json) {
  nlohmann::json list = nlohmann::json::array();
  for (const SubmittedStage& stage : stages) {
    list.push_back({{"name", stage.name}, {"job", stage.job}, {"tasks", stage.tasks}});
    if (!json) print(stage.job, "\n");
  }
  if (json) print_document({{"submitted", list}});
}

}  // namespace semigeo::jobs::cli
