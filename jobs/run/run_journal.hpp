#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include "jobs/archive/journal.hpp"
#include "jobs/run/job_outcome.hpp"

namespace semigeo::jobs {

/// Writes one run into the journal of its archive. If the journal cannot be written, the run goes
/// on without it.
class RunJournal : public JobListener {
 public:
  /// Writes the beginning of the run, and fills in the host, the process and the threads of `run`.
  RunJournal(const std::filesystem::path& archive, RunStarted run);

  void job_started(const PlannedJob& planned) override;
  void job_ended(const PlannedJob& planned, const JobOutcome& outcome) override;
  /// Writes the end of the run.
  void run_ended(const RunEnded& run);

  /// Returns why the journal of this run is not complete; empty if it is.
  const std::string& problem() const { return problem_; }

 private:
  void write(const JournalEvent& event);

  std::optional<Journal> journal_;
  std::string problem_;
};

/// Returns the ids of the jobs whose last end in the journal of an archive is a failure. If the
/// journal cannot be read, there are none.
std::set<std::string> failed_jobs(const std::filesystem::path& archive);

}  // namespace semigeo::jobs
