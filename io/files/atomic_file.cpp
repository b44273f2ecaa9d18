#include "io/files/atomic_file.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <fstream>
#include <span>
#include <string>
#include <system_error>
#include <utility>

#include "engine/descriptor.hpp"
#include "io/files/chunk_codec.hpp"
#include "io/files/write_error.hpp"

namespace semigeo::io {
namespace {

constexpr std::string_view kSuffix = ".partial";
constexpr std::size_t kLongestName = 255;

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& action, int error) {
  throw WriteError(
      error, path, "", action + ": " + std::generic_category().message(error),
      error == ENOSPC ? "free some space and run again" : "check the folder and its disk");
}

// Returns a name that is not too long for the file system, however long the final one is.
std::string temporary_name(std::string name) {
  std::string suffix = ".";
  suffix.append(host_name()).append(".").append(std::to_string(getpid())).append(kSuffix);
  if (1 + name.size() + suffix.size() > kLongestName) {
    const std::string hash = std::to_string(xxh3_64(std::as_bytes(std::span(name))));
    name.resize(kLongestName - 1 - suffix.size() - hash.size());
    name += hash;
  }
  return std::string(".").append(name).append(suffix);
}

void sync_path(const std::filesystem::path& path, const std::filesystem::path& shown_as,
               int flags) {
  const engine::Descriptor descriptor = engine::open_file(path, O_RDONLY | flags);
  if (!descriptor) fail(shown_as, "cannot open it to force it to the disk", errno);
  // Some network file systems know no fsync of a folder and say so with EINVAL.
  if (!engine::sync_file(descriptor) && errno != EINVAL)
    fail(shown_as, "cannot force it to the disk", errno);
}

// Returns the process that wrote ".<name>.<host>.<pid>.partial", or 0 if it ran on another host.
pid_t owner_of(std::string_view name, std::string_view host) {
  if (!name.starts_with('.') || !name.ends_with(kSuffix)) return 0;
  name.remove_suffix(kSuffix.size());
  const std::size_t dot = name.rfind('.');
  if (dot == std::string_view::npos) return 0;
  const std::string_view digits = name.substr(dot + 1);
  pid_t pid = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, pid);
  if (error != std::errc() || stop != end || pid <= 0) return 0;
  name = name.substr(0, dot);
  const bool ours = name.size() > host.size() + 1 && name.ends_with(host) &&
                    name[name.size() - host.size() - 1] == '.';
  return ours ? pid : 0;
}

/// Returns whether a process has ended, even if its parent has not waited for it yet.
bool is_dead(pid_t process) {
  if (::kill(process, 0) != 0 && errno == ESRCH) return true;
  std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
  std::string line;
  std::getline(stat, line);
  const std::size_t name_end = line.rfind(')');  // the name may hold anything
  return name_end != std::string::npos && name_end + 2 < line.size() &&
         (line[name_end + 2] == 'Z' || line[name_end + 2] == 'X');
}

}  // namespace

std::string host_name() {
  char name[256] = {};
  if (gethostname(name, sizeof name - 1) != 0 || name[0] == '\0') return "localhost";
  return name;
}

AtomicFile::AtomicFile(std::filesystem::path final_path)
    : final_path_(std::move(final_path)),
      temporary_path_(folder_of(final_path_) / temporary_name(final_path_.filename().string())) {
  // The name holds the id of this process, so the process that left the file has ended.
  std::error_code ignored;
  std::filesystem::remove(temporary_path_, ignored);
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!committed_) std::filesystem::remove(temporary_path_, ignored);
}

void AtomicFile::sync() {
  sync_path(temporary_path_, final_path_, 0);
  synced_ = true;
}

void AtomicFile::commit(Folder folder) {
  if (!synced_) sync();
  commit_unsynced();
  if (folder == Folder::kSynced)
    sync_path(folder_of(final_path_), folder_of(final_path_), O_DIRECTORY);
}

void AtomicFile::commit_unsynced() {
  if (std::rename(temporary_path_.c_str(), final_path_.c_str()) != 0)
    fail(final_path_, "cannot give the finished file its name", errno);
  committed_ = true;
}

void write_file_atomically(const std::filesystem::path& path, std::string_view content,
                           Folder folder) {
  AtomicFile file(path);
  {
    engine::Descriptor descriptor =
        engine::open_file(file.temporary_path(), O_WRONLY | O_CREAT | O_EXCL);
    if (!descriptor) fail(path, "cannot create it", errno);
    if (!engine::write_all(descriptor, content)) fail(path, "cannot write it", errno);
    if (descriptor.close() != 0) fail(path, "cannot write it", errno);
  }
  file.commit(folder);
}

int remove_stale_partials(const std::filesystem::path& folder) {
  int removed = 0;
  std::error_code error;
  const std::string host = host_name();
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const pid_t owner = owner_of(entry->path().filename().string(), host);
    if (owner == 0 || !is_dead(owner)) continue;
    std::error_code ignored;
    removed += std::filesystem::remove(entry->path(), ignored) ? 1 : 0;
  }
  return removed;
}

}  // namespace semigeo::io
