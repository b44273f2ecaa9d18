#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "io/files/error.hpp"
#include "jobs/archive/process_identity.hpp"

namespace semigeo::jobs {

/// Somebody else has the archive: says who, since when, and what to do.
class LockedError : public io::Error {
 public:
  using io::Error::Error;
};

/// One run at a time per archive: the file ARCHIVE/lock, which names its owner (host, boot, process
/// and when that started) and lives as long as the owner does. What a dead process of this host
/// left is taken over; of several that try at once one gets it.
class ArchiveLock {
 public:
  /// The archive must exist. LockedError if a living process of this host has it, one of another
  /// host, or one that cannot be made out; io::Error if the lock cannot be written.
  explicit ArchiveLock(const std::filesystem::path& archive);
  /// Frees the archive; not in a child that was forked from the owner.
  ~ArchiveLock();
  ArchiveLock(const ArchiveLock&) = delete;
  ArchiveLock& operator=(const ArchiveLock&) = delete;

 private:
  std::filesystem::path file_;
  ProcessIdentity owner_;
};

struct LockOwner {
  ProcessIdentity process;
  std::string since;  ///< "2024-05-31T21:00:00Z"
};

/// Who has the archive; nobody if the lock is a dead process's, or cannot be read.
std::optional<LockOwner> lock_owner(const std::filesystem::path& archive);

}  // namespace semigeo::jobs
