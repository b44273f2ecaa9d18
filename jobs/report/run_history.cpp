#include "jobs/report/run_history.hpp"

#include <algorithm>
#include <limits>
#include <string_view>
#include <utility>

#include "io/files/file_digest.hpp"
#include "jobs/archive/utc_time.hpp"
#include "jobs/report/report_files.hpp"

namespace semigeo::jobs {
namespace {

constexpr std::string_view kSurface = "surface ";

using IsShown = std::function<bool(const std::string& name)>;

class HistoryReader {
 public:
  explicit HistoryReader(const IsShown& is_shown) : is_shown_(is_shown) {}

  void read(const JournalEntry& entry) {
    if (const auto* run = std::get_if<RunStarted>(&entry.event)) {
      next_ = {.started = entry.time, .start = *run};
      next_name_ = entry.run;
    } else if (const auto* begun = std::get_if<JobStarted>(&entry.event)) {
      if (makes_page(begun->job)) return;
      take(entry);
      history_.running.insert(begun->job);
    } else if (const auto* job = std::get_if<JobEnded>(&entry.event)) {
      if (makes_page(job->job) && job->state != "failed") {
        add_page(entry, *job);
        return;
      }
      take(entry);
      end(*job, seconds_between(history_.run.started, entry.time));
    }
  }

  RunHistory finish() {
    for (LastRun* run : {&history_.run, &history_.night}) clip(*run);
    if (history_.run.made_datasets || history_.night.started.empty()) history_.night = history_.run;
    return std::move(history_);
  }

 private:
  /// The run that has this event is the last one that did something.
  void take(const JournalEntry& entry) {
    if (entry.run == next_name_) {
      if (history_.run.made_datasets) history_.night = std::move(history_.run);
      history_.run = std::move(next_);
      run_name_ = std::exchange(next_name_, "");
      history_.running.clear();
    }
    const auto* job = std::get_if<JobEnded>(&entry.event);
    std::string content = history_.digest;
    content.append("\n").append(entry.run).append("\n").append(entry.time);
    if (job != nullptr) content.append("\n").append(job->job).append("\n").append(job->state);
    history_.digest = io::xxh3_of_text(content);
  }

  /// Cuts off what pages took after all other jobs had ended.
  static void clip(LastRun& run) {
    std::erase_if(run.spans, [&](const RunSpan& span) { return span.begin >= run.seconds; });
    for (RunSpan& span : run.spans) span.end = std::min(span.end, run.seconds);
  }

  /// Adds the time of a page to that of its run, because it had a core. The first page, which ends
  /// last, is left out.
  void add_page(const JournalEntry& entry, const JobEnded& job) {
    if (job.job.starts_with(kReportKind)) return;
    const bool is_new = entry.run == next_name_;
    if (!is_new && entry.run != run_name_) return;
    LastRun& run = is_new ? next_ : history_.run;
    run.cpu_seconds += job.cpu_seconds;
    add_core_time(run, job, seconds_between(run.started, entry.time));
  }

  /// Forgets scans that are not shown of earlier runs that made datasets.
  void forget_others() {
    for (const std::string& name : others_) {
      history_.last.erase(name);
      history_.made.erase(name);
    }
    others_.clear();
  }

  void end(const JobEnded& job, double now) {
    history_.running.erase(job.job);
    LastRun& run = history_.run;
    ++run.ended[job.state];
    if (job.state == "failed") run.failed[job.job] = job.error;
    if (!makes_page(job.job)) add_span(job, now);
    if (!job.job.starts_with(kSurface)) return;
    const bool tried = job.state != "up to date";
    if (tried && !std::exchange(run.made_datasets, true)) forget_others();
    const std::string name = job.job.substr(kSurface.size());
    if (!is_shown_(name)) others_.push_back(name);
    history_.last[name] = job;
    if (job.state == "done") history_.made[name] = job;
  }

  void add_span(const JobEnded& job, double now) {
    LastRun& run = history_.run;
    run.cpu_seconds += job.cpu_seconds;
    run.peak_bytes = std::max(run.peak_bytes, job.peak_bytes);
    run.seconds = std::max({run.seconds, now, job.seconds});
    add_core_time(run, job, now);
  }

  static void add_core_time(LastRun& run, const JobEnded& job, double now) {
    if (job.seconds <= 0) return;
    const double size = static_cast<double>(job.vertices) * static_cast<double>(job.levels);
    run.spans.push_back({.begin = std::max(0.0, now - job.seconds),
                         .end = std::max(now, job.seconds),
                         .threads = static_cast<double>(std::max<std::int64_t>(1, job.threads)),
                         .vertex_levels = job.state == "done" ? size : 0});
  }

  RunHistory history_;
  LastRun next_;           ///< A run that has done nothing yet.
  std::string next_name_;  ///< Name of that run.
  std::string run_name_;   ///< Name of the last run that has done something.
  const IsShown& is_shown_;
  std::vector<std::string> others_;  ///< Names of scans of the last night that are not shown.
};

}  // namespace

RunHistory read_history(const std::filesystem::path& archive, const IsShown& is_shown) {
  HistoryReader reader(is_shown);
  read_journal(
      archive, [&](const JournalEntry& entry) { reader.read(entry); },
      std::numeric_limits<std::int64_t>::max());  // whole, for old scans
  return reader.finish();
}

}  // namespace semigeo::jobs
