#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <variant>

#include "engine/descriptor.hpp"

namespace semigeo::jobs {

/// The event at the start of a run.
struct RunStarted {
  std::string version = {};  ///< Version of the program.
  std::string host = {};
  std::int64_t pid = 0;
  std::int64_t threads = 0;
  std::int64_t jobs = 0;  ///< Number of jobs to be done.
  std::int64_t up_to_date = 0;
  std::int64_t input_bytes = 0;  ///< Size of the scans that are to be read.
  std::string passed_over = {};  ///< Files of folders that are no scans, in words.
  friend bool operator==(const RunStarted&, const RunStarted&) = default;
};

/// The event at the start of a job.
struct JobStarted {
  std::string job = {};  ///< "surface <name of the dataset>", "library library.h5", ...
  std::string key = {};  ///< Key with which its output will be up to date.
  friend bool operator==(const JobStarted&, const JobStarted&) = default;
};

/// The event at the end of a job. Values that are not known are zero or empty.
struct JobEnded {
  std::string job = {};
  std::string key = {};
  std::string state = {};  ///< "done", "failed", "skipped" or "up to date".
  std::string error = {};  ///< Why the job failed or was skipped, as one sentence.
  std::string format = {};
  /// What was repaired or lost, under the heading of its line: "repaired", "3 welded vertices".
  std::map<std::string, std::string> notes = {};
  double seconds = 0;
  double cpu_seconds = 0;
  double peak_bytes = 0;  ///< Largest use of memory.
  std::int64_t vertices = 0;
  std::int64_t levels = 0;
  std::int64_t input_bytes = 0;  ///< Size of the scan's file.
  std::int64_t threads = 0;
  friend bool operator==(const JobEnded&, const JobEnded&) = default;
};

/// The event at the end of a run.
struct RunEnded {
  std::int64_t done = 0;
  std::int64_t up_to_date = 0;
  std::int64_t failed = 0;
  double seconds = 0;
  double cpu_seconds = 0;
  friend bool operator==(const RunEnded&, const RunEnded&) = default;
};

/// An event of the journal.
using JournalEvent = std::variant<RunStarted, JobStarted, JobEnded, RunEnded>;

/// A line of ARCHIVE/journal.jsonl, which is a JSON object that begins with a checksum over the
/// rest of the line. The journal is for people and for estimates. It never decides whether an
/// output is up to date.
struct JournalEntry {
  JournalEvent event;
  std::string time;  ///< "2024-05-31T21:00:00Z"
  std::string run;   ///< Name of the run, the same for all its events.
};

/// Appends to the journal of an archive, which must exist. Only one thread may use it at a time.
class Journal {
 public:
  /// Opens the journal. Every line names the run `run`. Throws io::Error if the file cannot be
  /// opened.
  Journal(const std::filesystem::path& archive, std::string run);

  /// Appends a line with the present time. It is a single write, so that the line stays whole
  /// among the lines of other writers. If the last line is incomplete, because a run was killed or
  /// the disk was full, it is ended first. Throws io::Error if the line cannot be written.
  void write(const JournalEvent& event);

 private:
  std::filesystem::path path_;
  std::string run_;
  engine::Descriptor file_;
  bool torn_ = false;  ///< The last line has no end.
};

/// The name of the journal in its archive.
inline constexpr const char* kJournalName = "journal.jsonl";
/// The bytes at the end of a journal that are read: the lines of some ten thousand jobs.
inline constexpr std::int64_t kJournalTail = std::int64_t{32} << 20;

/// Calls `visit` for each entry of the journal, in order, and returns the number of damaged lines,
/// which are passed over. Events of later versions are passed over too. If the journal has more
/// than `most_bytes`, only the lines in its last bytes are read. An absent journal counts as empty.
/// Throws io::Error if the journal cannot be read. Keeps one line in memory.
std::int64_t read_journal(const std::filesystem::path& archive,
                          const std::function<void(const JournalEntry&)>& visit,
                          std::int64_t most_bytes = kJournalTail);

}  // namespace semigeo::jobs
