#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "jobs/archive/journal.hpp"
#include "jobs/run/local_executor.hpp"

namespace semigeo::jobs {

/// Writes one run into the journal of its archive. The run goes on without if that cannot be done.
class RunJournal : public JobListener {
 public:
  /// Begins the run; the host, process and threads of `run` are filled in.
  RunJournal(const std::filesystem::path& archive, RunStarted run);

  void job_started(const PlannedJob& planned) override;
  void job_ended(const PlannedJob& planned, const JobOutcome& outcome) override;
  void run_ended(const RunEnded& run);

  /// Why there is no whole journal of this run; empty if there is.
  const std::string& problem() const { return problem_; }

 private:
  void write(const JournalEvent& event);

  std::optional<Journal> journal_;
  std::string problem_;
};

}  // namespace semigeo::jobs
