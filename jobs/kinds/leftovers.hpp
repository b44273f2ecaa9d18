#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace semigeo::jobs {

/// What an archive still has of a scan or a scene that is gone.
struct Leftover {
  /// The kinds of leftovers.
  enum class Kind {
    kDataset,    ///< A dataset, its sidecar, its run of triplets and its logs.
    kRecognised  ///< What was recognised in a scene, and its log.
  };
  Kind kind = Kind::kDataset;
  std::string name;                          ///< Name of the dataset or of the recognised file.
  std::filesystem::path scan;                ///< Absolute path where the scan was.
  std::vector<std::filesystem::path> files;  ///< All that are there, the most important one first.
  std::uintmax_t bytes = 0;                  ///< Size of the files.
};

/// The leftovers of an archive.
struct Leftovers {
  std::vector<Leftover> list;  ///< Datasets by name, then recognised files by name.
  /// Folders of which everything would be removed, so that a disk may be missing: folders that were
  /// named and have none of their recorded scans any more, and folders below them that are empty
  /// although scans were in them.
  std::vector<std::filesystem::path> emptied;
};

/// Returns the folders that the archive's recorded scans and scenes were in. Folders below others
/// are left out. There is none if the folder is no archive.
std::vector<std::filesystem::path> recorded_folders(const std::filesystem::path& archive);

/// Finds what the archive has of scans that were in the folders, or below them, also behind
/// symbolic links that are there, and are gone. Scans about which nothing can be known, because a
/// folder cannot be searched or a disk does not answer, are not gone. Files that the archive's
/// sources.json does not name are nobody's leftovers, and neither are the datasets in `in_use`.
/// Throws io::Error if a folder does not exist. Writes nothing.
Leftovers find_leftovers(const std::filesystem::path& archive,
                         const std::vector<std::filesystem::path>& folders,
                         const std::set<std::string>& in_use = {});

/// Removes the files of the leftovers, and forgets their scans. The archive must be locked. Throws
/// io::Error if a file cannot be removed; what was removed before stays removed.
void remove_leftovers(const std::filesystem::path& archive, const std::vector<Leftover>& leftovers);

}  // namespace semigeo::jobs
