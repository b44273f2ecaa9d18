#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "jobs/archive/find_scans.hpp"

namespace semigeo::jobs {

/// By what a file that was not changed is known. The time of the last change of state is the
/// kernel's own: setting the time of the last modification back changes it.
struct FileStamp {
  std::int64_t size = 0;
  std::int64_t modified = 0;  ///< nanoseconds since 1970, like the next
  std::int64_t changed = 0;
  std::uint64_t inode = 0;
  friend bool operator==(const FileStamp&, const FileStamp&) = default;
};

/// Of a regular file; nothing of anything else.
std::optional<FileStamp> stamp_of(const std::filesystem::path& file);

/// What the root of a complete dataset says of where it comes from.
struct DatasetKeys {
  std::string job_key;
  std::string input_xxh3;
};

/// The digest of a scan, or why it cannot be had.
struct ScanDigest {
  std::string xxh3;
  std::string error;
};

/// Spares planning the reading of what has not changed since the last run. ARCHIVE/digests.txt
/// holds a line for each scan and dataset: digest, job key, stamp, path. What has another stamp is
/// read again; what was changed less than two seconds before it was read is not remembered, as a
/// second change could leave the same times. Only speed depends on the file: it may be removed.
class DigestCache {
 public:
  /// Nanoseconds since 1970.
  using Clock = std::int64_t (*)();
  static std::int64_t system_clock();

  /// Knows nothing yet.
  explicit DigestCache(std::filesystem::path archive, Clock clock = system_clock);
  /// What the archive's file says; nothing if there is none, or it is damaged or another version's.
  static DigestCache read(const std::filesystem::path& archive, Clock clock = system_clock);

  /// XXH3_128 of each scan's bytes, read on so many threads at once (0: one per core).
  std::vector<ScanDigest> scan_digests(const std::vector<FoundScan>& scans, int threads);
  /// Of the archive's dataset of this name; nothing if it is absent, unreadable or incomplete.
  std::optional<DatasetKeys> dataset_keys(const std::string& name);

  /// Replaces the archive's file, if it would say something else. Files that are gone are left out.
  void write();

 private:
  struct Entry {
    DatasetKeys keys;  ///< of a scan: its own digest, and no job
    FileStamp stamp;
    bool used = false;
  };
  struct Reading;
  const Entry* find(const std::string& path, const std::optional<FileStamp>& stamp) const;
  void remember(const std::string& path, const Reading& reading);
  std::filesystem::path file_of(const std::string& path) const;

  std::filesystem::path archive_;
  Clock now_;
  std::map<std::string, Entry> entries_;  ///< by path of a scan, by name of a dataset
  std::string text_;                      ///< of the archive's file
};

/// Where an archive has the dataset of this name.
std::filesystem::path dataset_path(const std::filesystem::path& archive, const std::string& name);

}  // namespace semigeo::jobs
