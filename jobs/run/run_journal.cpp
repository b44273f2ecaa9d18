#include "jobs/run/run_journal.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include "io/files/error.hpp"
#include "jobs/archive/process_identity.hpp"
#include "jobs/archive/utc_time.hpp"
#include "jobs/plan/job_kind.hpp"

namespace semigeo::jobs {
namespace {

/// Returns a name for the run that sorts by time and that no other run has.
std::string run_name(const ProcessIdentity& process) {
  return utc_time() + " " + process.host + " " + std::to_string(process.pid);
}

}  // namespace

RunJournal::RunJournal(const std::filesystem::path& archive, RunStarted run) {
  const ProcessIdentity process = this_process();
  run.host = process.host;
  run.pid = process.pid;
  if (run.threads <= 0) run.threads = std::max(1U, std::thread::hardware_concurrency());
  try {
    journal_.emplace(archive, run_name(process));
  } catch (const io::Error& e) {
    problem_ = e.what();
  }
  write(run);
}

void RunJournal::write(const JournalEvent& event) {
  if (!journal_) return;
  try {
    journal_->write(event);
  } catch (const io::Error& e) {
    if (problem_.empty()) problem_ = e.what();  // the disk may have room again later
  }
}

void RunJournal::job_started(const PlannedJob& planned) {
  write(JobStarted{.job = job_id(planned.job), .key = planned.job.key});
}

void RunJournal::job_ended(const PlannedJob& planned, const JobOutcome& outcome) {
  JobEnded ended{.job = job_id(planned.job),
                 .key = planned.job.key,
                 .state = std::string(name_of(outcome.state)),
                 .error = outcome.error,
                 .seconds = outcome.seconds,
                 .cpu_seconds = outcome.cpu_seconds,
                 .peak_bytes = outcome.peak_bytes,
                 .threads = outcome.threads};
  if (outcome.result.has_value())
    for (ReportLine& line : planned.job.kind->report(planned.job, outcome.result).lines)
      if (!line.text.empty()) ended.notes[line.heading] = std::move(line.text);
  planned.job.kind->describe(planned.job, outcome.result, ended);
  write(ended);
}

void RunJournal::run_ended(const RunEnded& run) {
  write(run);
}

std::set<std::string> failed_jobs(const std::filesystem::path& archive) {
  std::set<std::string> failed;
  try {
    read_journal(archive, [&](const JournalEntry& entry) {
      const auto* job = std::get_if<JobEnded>(&entry.event);
      if (job == nullptr) return;
      if (job->state == name_of(JobState::kFailed))
        failed.insert(job->job);
      else
        failed.erase(job->job);
    });
  } catch (const io::Error&) {
    return {};
  }
  return failed;
}

}  // namespace semigeo::jobs
