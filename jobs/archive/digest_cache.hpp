#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "jobs/archive/containers.hpp"
#include "jobs/archive/find_scans.hpp"

namespace semigeo::jobs {

/// The properties by which an unchanged file is recognised. The time of the last change of state is
/// set by the kernel alone: setting back the time of the last modification changes it.
struct FileStamp {
  std::int64_t size = 0;
  std::int64_t modified = 0;  ///< Time of the last modification, in nanoseconds since 1970.
  std::int64_t changed = 0;   ///< Time of the last change of state, in nanoseconds since 1970.
  std::uint64_t inode = 0;
  friend bool operator==(const FileStamp&, const FileStamp&) = default;
};

/// Returns the stamp of a regular file, or nothing.
std::optional<FileStamp> stamp_of(const std::filesystem::path& file);

/// Holds what the root of a complete dataset says about its origin.
struct DatasetKeys {
  std::string job_key;
  std::string input_xxh3;
};

/// Remembers digests, so that planning need not read files that have not changed since the last
/// run. ARCHIVE/digests.txt holds a line for each scan and dataset: digest, job key, stamp, path.
/// Behind a scan follows a line for each of its companions, which begins with "+". A file with
/// another stamp, or a companion with another one, is read again. A member of a container has the
/// stamp of the container. A file that was changed less than two seconds before it was read is not
/// remembered, because a second change could leave the same times. Only speed depends on
/// digests.txt: it may be removed.
class DigestCache {
 public:
  /// Returns the time in nanoseconds since 1970.
  using Clock = std::int64_t (*)();
  /// Returns the time of the system.
  static std::int64_t system_clock();

  /// Makes a cache that knows nothing yet.
  explicit DigestCache(std::filesystem::path archive, Clock clock = system_clock);
  /// Reads what the archive's file says. The cache knows nothing if there is none, or if it is
  /// damaged or another version's.
  static DigestCache read(const std::filesystem::path& archive, Clock clock = system_clock);

  /// Returns the XXH3_128 of each scan's bytes, read on at most this number of threads at once (0:
  /// one for each core). A container is read once for all its members.
  std::vector<ScanDigest> scan_digests(const std::vector<FoundScan>& scans, int threads);
  /// Returns the keys of the archive's dataset of this name, or nothing if it is absent, unreadable
  /// or incomplete.
  std::optional<DatasetKeys> dataset_keys(const std::string& name);

  /// Replaces the archive's file, if it would say something else. Files that are gone are left out.
  void write();

 private:
  /// A file that belongs to a scan.
  struct Companion {
    std::string path;
    FileStamp stamp;  ///< All zeros if it is absent.
  };
  struct Entry {
    DatasetKeys keys;  ///< A scan has its own digest, and no job.
    FileStamp stamp;
    std::vector<Companion> companions = {};
    bool used = false;
  };
  struct Reading;
  void digest_members(const std::vector<FoundScan>& scans, int threads,
                      std::vector<Reading>& readings, std::vector<ScanDigest>& digests) const;
  /// Reads a scan that is no member of a container.
  static ScanDigest digest_file(const FoundScan& scan, Reading& reading);
  /// Begins a reading of a scan. Returns its entry if it has not changed.
  const Entry* begin(const FoundScan& scan, Reading& reading) const;
  static void end(const FoundScan& scan, const ScanDigest& digest, Reading& reading);
  const Entry* find(const std::string& path, const std::optional<FileStamp>& stamp) const;
  void remember(const std::string& path, const Reading& reading);
  std::filesystem::path file_of(const std::string& path) const;

  std::filesystem::path archive_;
  Clock now_;
  /// The key is the path of a scan or the name of a dataset.
  std::map<std::string, Entry> entries_;
  std::string text_;  ///< Text of the archive's file.
};

/// Returns where an archive has the dataset of this name.
std::filesystem::path dataset_path(const std::filesystem::path& archive, const std::string& name);

}  // namespace semigeo::jobs
