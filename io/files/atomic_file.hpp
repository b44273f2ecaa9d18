#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace semigeo::io {

/// Returns the name of this host in temporary files and locks: "localhost" if it has no name.
std::string host_name();

/// Says whether a folder is forced to the disk, so that the names in it survive a power cut. kLeft
/// is for a file after which another file of the folder gets its name and syncs the folder.
enum class Folder { kSynced, kLeft };

/// A file that appears under its final name whole or not at all. It is written under a temporary
/// name in the same folder, ".<name>.<host>.<pid>.partial", and renamed by `commit`. Without a
/// commit the destructor removes it. Writers in different processes, on one host or several, do not
/// meet. Within a process one final name must have one writer at a time.
class AtomicFile {
 public:
  /// Composes the temporary name, and removes a file that has it already. Creates nothing.
  explicit AtomicFile(std::filesystem::path final_path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& final_path() const { return final_path_; }
  const std::filesystem::path& temporary_path() const { return temporary_path_; }

  /// Forces what was written (and closed) to the disk. Nothing may be written afterwards. Throws
  /// Error if it fails.
  void sync();

  /// Syncs, if that has not been done, renames to the final name (replacing what stood there), and
  /// syncs the folder if asked to.
  void commit(Folder folder = Folder::kSynced);
  /// Renames without any sync. That is a hundred times as fast, but after a power cut the file may
  /// hold any bytes under its final name. It is for files that are checked before use and easily
  /// made again.
  void commit_unsynced();

 private:
  std::filesystem::path final_path_;
  std::filesystem::path temporary_path_;
  bool synced_ = false;
  bool committed_ = false;
};

/// Writes a small file whole or not at all, as AtomicFile does. Throws Error if it fails.
void write_file_atomically(const std::filesystem::path& path, std::string_view content,
                           Folder folder = Folder::kSynced);

/// Removes the temporary files in `folder` that dead processes of this host left, and returns how
/// many. Files of other hosts and of living processes stay. A folder that does not exist holds
/// none.
int remove_stale_partials(const std::filesystem::path& folder);

}  // namespace semigeo::io
