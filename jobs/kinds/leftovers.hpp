#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "io/files/error.hpp"
#include "io/files/read_error.hpp"

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
  /// Of these only the record is there. There is none if their disk may be missing.
  std::vector<Leftover> recorded;
  std::vector<io::ReadError> unknown;  ///< Scans and scenes about which nothing can be known: why.
};

/// What came of removing leftovers.
struct Removal {
  std::vector<Leftover> removed;    ///< Those of which no file is there any more.
  std::vector<Leftover> left;       ///< The others.
  std::vector<io::Error> failures;  ///< The files that could not be removed or written, and why.
};

/// Returns the folders that the archive's recorded scans and scenes were in. Folders below others
/// are left out. There is none if the folder is no archive.
std::vector<std::filesystem::path> recorded_folders(const std::filesystem::path& archive);

/// Finds what the archive has of scans that were in the folders, or below them, also behind
/// symbolic links that are there, and are gone. Scans about which nothing can be known, because a
/// folder cannot be searched or a disk does not answer, are not gone. Files that the archive's
/// sources.json does not name are nobody's leftovers, and neither are the datasets in `in_use`.
/// Throws io::Error if a folder does not exist, or if the archive cannot be searched. Writes
/// nothing.
Leftovers find_leftovers(const std::filesystem::path& archive,
                         const std::vector<std::filesystem::path>& folders,
                         const std::set<std::string>& in_use = {});

/// Removes the files of the leftovers, and forgets the scans of which nothing is there any more.
/// What cannot be removed stays and harms no other. The archive must be locked. Throws io::Error,
/// and removes nothing, if links lead out of the archive or its records cannot be read.
Removal remove_leftovers(const std::filesystem::path& archive, const Leftovers& leftovers);

}  // namespace semigeo::jobs
