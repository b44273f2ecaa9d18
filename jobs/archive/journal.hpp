#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <variant>

#include "engine/descriptor.hpp"

namespace semigeo::jobs {

struct RunStarted {
  std::string version = {};  ///< of the program
  std::string host = {};
  std::int64_t pid = 0;
  std::int64_t threads = 0;
  std::int64_t jobs = 0;  ///< to be done
  std::int64_t up_to_date = 0;
  std::int64_t input_bytes = 0;  ///< of the scans that are to be read
  friend bool operator==(const RunStarted&, const RunStarted&) = default;
};

struct JobStarted {
  std::string job = {};  ///< "surface <name of the dataset>", "library library.h5", ...
  std::string key = {};  ///< under which its output will be up to date
  friend bool operator==(const JobStarted&, const JobStarted&) = default;
};

/// What is not known is zero or empty.
struct JobEnded {
  std::string job = {};
  std::string key = {};
  std::string state = {};  ///< "done", "failed", "skipped", or "up to date" after all
  std::string error = {};  ///< of a failed or skipped job: one sentence
  std::string format = {};
  double seconds = 0;
  double cpu_seconds = 0;
  double peak_bytes = 0;  ///< of memory
  std::int64_t vertices = 0;
  std::int64_t levels = 0;
  std::int64_t input_bytes = 0;  ///< of the scan's file
  std::int64_t threads = 0;
  friend bool operator==(const JobEnded&, const JobEnded&) = default;
};

struct RunEnded {
  std::int64_t done = 0;
  std::int64_t up_to_date = 0;
  std::int64_t failed = 0;
  double seconds = 0;
  double cpu_seconds = 0;
  friend bool operator==(const RunEnded&, const RunEnded&) = default;
};

using JournalEvent = std::variant<RunStarted, JobStarted, JobEnded, RunEnded>;

/// A line of ARCHIVE/journal.jsonl: a JSON object that begins with a checksum over the rest of the
/// line. The journal is for people and for estimates; what is up to date never depends on it.
struct JournalEntry {
  JournalEvent event;
  std::string time;  ///< "2024-05-31T21:00:00Z"
  std::string run;   ///< the same for all events of one run
};

/// Appends to the journal of an archive, which must exist. One thread at a time.
class Journal {
 public:
  /// `run` is the run's name in every line. Error if the file cannot be opened.
  Journal(const std::filesystem::path& archive, std::string run);

  /// Appends one line with the present time, in one write, so that it stands whole among those of
  /// other writers. A torn line before it, of a run that was killed or a disk that was full, is
  /// ended first. Error if it cannot be written.
  void write(const JournalEvent& event);

 private:
  std::filesystem::path path_;
  std::string run_;
  engine::Descriptor file_;
  bool torn_ = false;  ///< the last line has no end
};

/// Reads the journal from its beginning and returns how many lines were damaged and passed over.
/// Events of later versions are passed over too. No journal is an empty one; Error if there is one
/// that cannot be read. Memory: one line.
std::int64_t read_journal(const std::filesystem::path& archive,
                          const std::function<void(const JournalEntry&)>& visit);

}  // namespace semigeo::jobs
