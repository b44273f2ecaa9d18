#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "io/files/error.hpp"
#include "jobs/archive/process_identity.hpp"

namespace semigeo::jobs {

/// The error when another process has the archive. Its text says which process, since when, and
/// what to do.
class LockedError : public io::Error {
 public:
  using io::Error::Error;
};

/// Lets one run at a time use an archive. The lock is the file ARCHIVE/lock, which names its owner
/// (host, boot, process and the start of the process) and exists as long as this object. The lock
/// of a dead process of this host is taken over. If several processes try at once, one gets it.
class ArchiveLock {
 public:
  /// Locks an archive, which must exist. Throws LockedError if the owner of the lock is alive, is
  /// on another host, or is unknown. Throws io::Error if the lock cannot be written.
  explicit ArchiveLock(const std::filesystem::path& archive);
  /// Frees the archive. It does nothing in a child that was forked from the owner.
  ~ArchiveLock();
  ArchiveLock(const ArchiveLock&) = delete;
  ArchiveLock& operator=(const ArchiveLock&) = delete;

 private:
  std::filesystem::path file_;
  ProcessIdentity owner_;
};

/// Removes the lock that this process has, if any. Only for a process that is about to end: it may
/// be called in a signal handler.
void remove_own_lock() noexcept;

/// The owner of a lock.
struct LockOwner {
  ProcessIdentity process;
  std::string since;  ///< Time of locking, "2024-05-31T21:00:00Z".
};

/// Returns who has the archive. Returns nothing if there is no lock, if its owner is dead, or if it
/// cannot be read.
std::optional<LockOwner> lock_owner(const std::filesystem::path& archive);

}  // namespace semigeo::jobs
