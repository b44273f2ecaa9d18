#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "jobs/archive/journal.hpp"

namespace semigeo::jobs {

/// A job of a run that has ended.
struct RunSpan {
  double begin = 0;  ///< Seconds since the start of the run.
  double end = 0;
  double threads = 0;
  double vertex_levels = 0;  ///< Vertices times levels of the dataset that the job has made.
};

/// The last run of an archive that did something besides making pages.
struct LastRun {
  std::string started = {};  ///< In UTC; empty if there was no run.
  RunStarted start = {};
  double seconds = 0;      ///< From the start to the end of the last job that is not about pages.
  double cpu_seconds = 0;  ///< Of its jobs.
  double peak_bytes = 0;   ///< Of the job that took most memory.
  std::map<std::string, std::int64_t> ended = {};  ///< Number of jobs by their state.
  std::map<std::string, std::string> failed = {};  ///< Reason, by name of the job.
  std::vector<RunSpan> spans = {};  ///< Jobs that are done or have failed, and pages.
  bool made_datasets = false;       ///< It has done or tried surface jobs.
};

/// The journal as a report shows it. Jobs that make pages are left out, unless they have failed, so
/// that a report does not change itself. The cores that pages of scans and scenes had during a run
/// count.
struct RunHistory {
  std::map<std::string, JobEnded> last;  ///< The last end, by name of the dataset.
  std::map<std::string, JobEnded> made;  ///< The last end with a dataset, by its name.
  LastRun run;                           ///< The last run.
  LastRun night;  ///< The last run that made datasets, or tried to; or else the last run.
  std::set<std::string> running;  ///< Jobs of the last run that have begun and not ended.
  std::string digest;  ///< Hash of all that was read: what is shown changes only if it changes.
};

/// Reads all of the journal of an archive. Keeps the last end of each dataset whose name
/// `is_shown`, and all about the last run and the last one that made datasets, so that the memory
/// does not grow with the journal.
/// Throws io::Error if the journal cannot be read.
RunHistory read_history(
    const std::filesystem::path& archive,
    const std::function<bool(const std::string& name)>& is_shown = [](const std::string&) {
      return true;
    });

}  // namespace semigeo::jobs
