#include "jobs/archive/archive_lock.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <system_error>

#include "engine/descriptor.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/json_value.hpp"
#include "jobs/archive/utc_time.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFileName = "lock";

using Owner = LockOwner;

// The lock of this process, for a signal handler.
std::atomic<bool> has_lock = false;
std::string own_file;
std::string own_text;

std::string text_of(const Owner& owner) {
  const ProcessIdentity& process = owner.process;
  const nlohmann::ordered_json document = {{"host", process.host},
                                           {"pid", process.pid},
                                           {"boot_id", process.boot_id},
                                           {"process_started", process.started},
                                           {"since", owner.since}};
  return document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
}

std::optional<Owner> owner_in(const std::string& text) {
  try {
    const auto document = nlohmann::json::parse(text);
    Owner owner;
    document.at("host").get_to(owner.process.host);
    io::read_value(document.at("pid"), owner.process.pid);
    document.at("boot_id").get_to(owner.process.boot_id);
    io::read_value(document.at("process_started"), owner.process.started);
    document.at("since").get_to(owner.since);
    return owner;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

/// Returns the text of an open lock, or an empty text if it cannot be read.
std::string content_of(const engine::Descriptor& lock) {
  std::array<char, 4096> buffer;
  ssize_t count;
  do {
    count = pread(lock.get(), buffer.data(), buffer.size(), 0);
  } while (count < 0 && errno == EINTR);
  return count > 0 ? std::string(buffer.data(), static_cast<std::size_t>(count)) : std::string();
}

[[noreturn]] void fail(const fs::path& file, int error) {
  throw io::Error(file, "", "cannot be written: " + std::generic_category().message(error),
                  "check the archive, its permissions and the free space");
}

[[noreturn]] void refuse(const fs::path& file, const std::optional<Owner>& owner) {
  if (!owner)
    throw LockedError(file, "", "another run has the archive, but this file does not say which",
                      "remove the file if none is under way");
  const ProcessIdentity& process = owner->process;
  const std::string who = "process " + std::to_string(process.pid) + " on " + process.host +
                          " has the archive since " + owner->since;
  if (life_of(process) == Life::kOnAnotherHost)
    throw LockedError(file, "", who,
                      "wait until it ends; if it is gone from that host, remove the file");
  throw LockedError(file, "", who, "wait until it ends, or end it");
}

/// Gives a finished file its name unless the name is taken. Returns whether it was free.
bool place(const fs::path& from, const fs::path& to) {
  if (link(from.c_str(), to.c_str()) == 0) return true;
  const int error = errno;
  struct stat status {};
  // The answer of a file server may have been lost, and its repetition finds the name taken.
  if (stat(from.c_str(), &status) == 0 && status.st_nlink == 2) return true;
  if (error == EEXIST) return false;
  // Some file systems know no links: those of memory cards and of some servers.
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
  if (errno == EEXIST) return false;
  fail(to, error);
}

/// Waits for the right to replace this very file, which lasts until it is closed. Returns false if
/// the file system has no such locks.
bool guard(const engine::Descriptor& lock) {
  struct flock whole {};
  whole.l_type = F_WRLCK;
  whole.l_whence = SEEK_SET;
  while (fcntl(lock.get(), F_OFD_SETLKW, &whole) != 0)
    if (errno != EINTR) return false;
  return true;
}

bool is_at(const engine::Descriptor& lock, const fs::path& file) {
  struct stat opened {};
  struct stat named {};
  return fstat(lock.get(), &opened) == 0 && stat(file.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

/// Replaces the lock of a dead owner by `ours`. Throws LockedError if the owner is not dead.
/// Returns false if the lock was freed or taken meanwhile; then the caller begins again.
bool take_over(const fs::path& ours, const fs::path& file) {
  const engine::Descriptor lock = engine::open_file(file, O_RDWR | O_NONBLOCK | O_NOFOLLOW);
  if (!lock && errno == ENOENT) return false;
  if (!lock) fail(file, errno);
  const bool guarded = guard(lock);
  if (!is_at(lock, file)) return false;
  const auto owner = owner_in(content_of(lock));
  if (!owner || life_of(owner->process) != Life::kDead) refuse(file, owner);
  if (!guarded)
    throw LockedError(file, "", "a run that has died had the archive",
                      "remove the file: this file system does not let programs agree on who may");
  if (std::rename(ours.c_str(), file.c_str()) != 0) fail(file, errno);
  return true;
}

}  // namespace

ArchiveLock::ArchiveLock(const fs::path& archive)
    : file_(archive / kFileName), owner_(this_process()) {
  io::AtomicFile ours(file_);  // it has a name of its own, and is removed in any case
  const std::string content = text_of({owner_, utc_time()});
  {
    const engine::Descriptor text =
        engine::open_file(ours.temporary_path(), O_WRONLY | O_CREAT | O_EXCL);
    if (!text) fail(file_, errno);
    if (!engine::write_all(text, content)) fail(file_, errno);
  }
  ours.sync();
  while (!place(ours.temporary_path(), file_) && !take_over(ours.temporary_path(), file_)) {
  }
  has_lock = false;
  own_file = file_;
  own_text = content;
  has_lock = true;
}

ArchiveLock::~ArchiveLock() {
  if (owner_.pid != getpid()) return;
  has_lock = false;
  // No process replaces the lock of a living owner. But if the lock was removed by hand, another
  // process may have it now.
  const engine::Descriptor lock = engine::open_file(file_, O_RDONLY | O_NONBLOCK);
  const auto owner = lock ? owner_in(content_of(lock)) : std::nullopt;
  if (owner && owner->process == owner_) unlink(file_.c_str());
}

void remove_own_lock() noexcept {
  if (!has_lock.exchange(false)) return;
  const int lock = open(own_file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  char buffer[4096];
  const ssize_t size = lock < 0 ? -1 : read(lock, buffer, sizeof buffer);
  if (size >= 0 && std::string_view(buffer, static_cast<std::size_t>(size)) == own_text)
    unlink(own_file.c_str());
}

std::optional<LockOwner> lock_owner(const fs::path& archive) {
  const engine::Descriptor lock = engine::open_file(archive / kFileName, O_RDONLY | O_NONBLOCK);
  if (!lock) return std::nullopt;
  const auto owner = owner_in(content_of(lock));
  return owner && life_of(owner->process) != Life::kDead ? owner : std::nullopt;
}

}  // namespace semigeo::jobs
