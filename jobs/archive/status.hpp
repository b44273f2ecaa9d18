#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "jobs/archive/archive_lock.hpp"
#include "jobs/archive/journal.hpp"

namespace semigeo::jobs {

/// The state of the last run of an archive, as its journal and its lock tell.
struct ArchiveStatus {
  std::int64_t datasets = 0;           ///< Number of complete datasets.
  std::optional<RunStarted> last_run;  ///< Empty if the journal has no run.
  std::string started;                 ///< Start of the run in UTC.
  std::optional<LockOwner> owner;      ///< The process that has the archive now.
  bool ended = false;                  ///< The journal has the end of the run.
  std::int64_t done = 0;
  std::map<std::string, std::int64_t> done_by_kind = {};  ///< The key is "surface", "triplets", ...
  std::int64_t up_to_date = 0;                            ///< Includes jobs that turned out to be.
  std::int64_t skipped = 0;                   ///< Jobs that need the result of a failed one.
  std::map<std::string, double> running;      ///< Seconds since the start, by name of the job.
  std::map<std::string, std::string> failed;  ///< Reason, by name of the job.
  /// What was repaired or lost in jobs that are done, by heading, by name of the job.
  std::map<std::string, std::map<std::string, std::string>> notes;
  double seconds = 0;              ///< Time from the start to the last event, or to now.
  double vertex_levels = 0;        ///< Vertices times levels of jobs that are done.
  std::int64_t bytes_done = 0;     ///< Size of the scans of jobs that have ended.
  std::int64_t damaged_lines = 0;  ///< Number of damaged lines of the journal.

  bool is_running() const { return owner.has_value() && last_run.has_value() && !ended; }
  /// Returns the number of jobs that have not ended.
  std::int64_t left() const;
  double vertex_levels_per_second() const { return seconds > 0 ? vertex_levels / seconds : 0; }
  /// Returns the time left, judged by the bytes of the scans, or nothing if no job has ended yet.
  std::optional<double> seconds_left() const;
};

/// Returns the state of the last run in one or two words: "never run", "starting", "running",
/// "interrupted", "stopped early" or "ended".
const char* state_of(const ArchiveStatus& status);

/// Reads the state of the last run. Throws io::Error if the folder is no archive, or if its journal
/// cannot be read.
ArchiveStatus status_of(const std::filesystem::path& archive);

}  // namespace semigeo::jobs
