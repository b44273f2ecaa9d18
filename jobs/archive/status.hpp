#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "jobs/archive/archive_lock.hpp"
#include "jobs/archive/journal.hpp"

namespace semigeo::jobs {

/// How the last run of an archive stands, by its journal; and whether it still runs, by its lock.
struct ArchiveStatus {
  std::int64_t datasets = 0;           ///< under final names
  std::optional<RunStarted> last_run;  ///< nothing: the journal knows of none
  std::string started;                 ///< when, UTC
  std::optional<LockOwner> owner;      ///< whoever has the archive now
  bool ended = false;                  ///< the journal has its end
  std::int64_t done = 0;
  std::map<std::string, std::int64_t> done_by_kind = {};  ///< "surface", "triplets", ...
  std::int64_t up_to_date = 0;                            ///< some only turned out to be
  std::int64_t skipped = 0;                               ///< as others had failed
  std::map<std::string, double> running;      ///< name of a job, seconds since it was started
  std::map<std::string, std::string> failed;  ///< name of a job, its reason
  double seconds = 0;                         ///< from its start to its last event, or to now
  double vertex_levels = 0;                   ///< of jobs that are done
  std::int64_t bytes_done = 0;                ///< of the scans of jobs that have ended
  std::int64_t damaged_lines = 0;             ///< of the journal

  bool is_running() const { return owner.has_value() && last_run.has_value() && !ended; }
  std::int64_t left() const;
  double vertex_levels_per_second() const { return seconds > 0 ? vertex_levels / seconds : 0; }
  /// Judged by the bytes of the scans; nothing while nothing has ended.
  std::optional<double> seconds_left() const;
};

/// Error if the archive is none, or its journal cannot be read.
ArchiveStatus status_of(const std::filesystem::path& archive);

}  // namespace semigeo::jobs
