#include "jobs/archive/status.hpp"

#include <algorithm>

#include "io/files/error.hpp"
#include "jobs/archive/dataset_files.hpp"
#include "jobs/archive/utc_time.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

/// Reads the journal line by line, and starts again with every run.
class Reader {
 public:
  Reader(ArchiveStatus& status, bool begins_late) : status_(status), begins_late_(begins_late) {}

  void read(const JournalEntry& entry) {
    if (const auto* run = std::get_if<RunStarted>(&entry.event)) begin(*run, entry);
    // The beginning of a very long run is not read. Then the end of the journal begins within it.
    if (begins_late_ && !status_.last_run) begin({}, entry);
    if (entry.run != run_) return;  // an event of another run
    last_time_ = entry.time;
    if (const auto* job = std::get_if<JobStarted>(&entry.event)) started_[job->job] = entry.time;
    if (const auto* job = std::get_if<JobEnded>(&entry.event)) end(*job);
    if (std::holds_alternative<RunEnded>(entry.event)) status_.ended = true;
  }

  void finish() {
    if (!status_.last_run) return;
    const double now = seconds_since(status_.started);
    status_.seconds = status_.is_running() ? now : now - seconds_since(last_time_);
    for (const auto& [job, time] : started_) status_.running[job] = seconds_since(time);
  }

 private:
  void begin(const RunStarted& run, const JournalEntry& entry) {
    const std::optional<LockOwner> owner = status_.owner;
    const std::int64_t datasets = status_.datasets;
    status_ = {};
    status_.owner = owner;
    status_.datasets = datasets;
    status_.last_run = run;
    status_.up_to_date = run.up_to_date;
    status_.started = entry.time;
    started_.clear();
    run_ = entry.run;
  }

  void end(const JobEnded& job) {
    started_.erase(job.job);
    status_.bytes_done += job.input_bytes;
    if (job.state == "failed") {
      status_.failed[job.job] = job.error;
      return;
    }
    if (job.state == "up to date") ++status_.up_to_date;
    if (job.state == "skipped") ++status_.skipped;
    if (job.state != "done") return;
    ++status_.done;
    if (!job.notes.empty()) status_.notes[job.job] = job.notes;
    ++status_.done_by_kind[job.job.substr(0, job.job.find(' '))];
    status_.vertex_levels += static_cast<double>(job.vertices) * static_cast<double>(job.levels);
  }

  ArchiveStatus& status_;
  bool begins_late_;  ///< The beginning of the journal is not read.
  std::string run_;
  std::string last_time_;
  std::map<std::string, std::string> started_;  ///< Start of jobs that have not ended.
};

}  // namespace

std::int64_t ArchiveStatus::left() const {
  if (!last_run) return 0;
  const auto failures = static_cast<std::int64_t>(failed.size());
  const std::int64_t spared = up_to_date - last_run->up_to_date + skipped;
  return std::max<std::int64_t>(0, last_run->jobs - done - failures - spared);
}

std::optional<double> ArchiveStatus::seconds_left() const {
  if (!is_running() || bytes_done <= 0) return std::nullopt;
  const auto all = static_cast<double>(last_run->input_bytes);
  const auto read = static_cast<double>(bytes_done);
  return seconds * std::max(0.0, all - read) / read;
}

const char* state_of(const ArchiveStatus& status) {
  if (!status.last_run) return status.owner ? "starting" : "never run";
  if (status.is_running()) return "running";
  if (!status.ended) return "interrupted";
  return status.left() > 0 ? "stopped early" : "ended";
}

ArchiveStatus status_of(const fs::path& archive) {
  if (!fs::is_directory(archive))
    throw io::Error(archive, "", "is no archive", "give the folder that was --output of a run");
  ArchiveStatus status;
  status.owner = lock_owner(archive);
  status.datasets = std::ssize(dataset_files(archive / "scans"));
  std::error_code ignored;
  const std::uintmax_t bytes = fs::file_size(archive / kJournalName, ignored);
  Reader reader(status, !ignored && bytes > std::uintmax_t{kJournalTail});
  status.damaged_lines =
      read_journal(archive, [&](const JournalEntry& entry) { reader.read(entry); });
  reader.finish();
  return status;
}

}  // namespace semigeo::jobs
