#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace semigeo::jobs {

/// A scan: a file or a member of a container. If `error` is set it is something that cannot be
/// read: a scan, or a folder or a container in which scans cannot be looked for.
struct FoundScan {
  std::filesystem::path input;
  std::string relative;        ///< Path below the folder it was found in, or its file name.
  std::string name;            ///< Name of its dataset, unless a scan of another folder has it.
  std::filesystem::path file;  ///< Absolute path, the same for every path to one file.
  std::string error;           ///< Why it cannot be read or searched; empty for a scan.
  /// The container that it is a member of; empty for a file. `input` leads through it.
  std::filesystem::path container = {};
  std::uintmax_t bytes = 0;  ///< Size of the member as the container tells it.
};

/// The files that a search of folders has passed over because they are no scans, and belong to none
/// (io/scans/companions.hpp).
struct PassedOver {
  /// The number of files of each kind. A kind is an extension in lower case (".jpg"), or "other".
  std::map<std::string, std::int64_t> files = {};
  /// Sentences about what may have been meant: containers in containers, for example.
  std::vector<std::string> notes = {};

  /// Counts one file of a kind less.
  void forget(const std::string& kind);
};

/// Returns "12 .jpg, 3 .mtl, 2 other", the most frequent kind first, or an empty text. The kinds
/// behind the first twenty are "other", too.
std::string in_words(const PassedOver& passed_over);

/// What a search has found.
struct FoundScans {
  std::vector<FoundScan> scans;
  PassedOver passed_over;
};

/// Returns the scans that the inputs name, in a fixed order: inputs as given, and the content of
/// folders, searched recursively, by name. Symbolic links to folders are followed. A folder that
/// can be reached in several ways is searched once: by the way without links if there is one,
/// otherwise by the link that comes first by name. A file is found once, under the first of its
/// names. Hidden files and folders and the archive itself are passed over and not counted.
///
/// Containers (io/files/container.hpp) are searched like folders. Each is listed once, in a child
/// process. An input may also lead through a container, to a scan or a folder in it.
///
/// A name is the path relative to the folder in which the scan was found. Folders are joined by
/// "__", and anything but letters, digits, '.', '-' and '_' is replaced; names that could be
/// misread end in a hash of the path. The name depends on that path alone. Throws io::Error if an
/// input does not exist, cannot be searched, or is a file that is no scan.
FoundScans find_scans(const std::vector<std::filesystem::path>& inputs,
                      const std::filesystem::path& archive);

/// Returns the folders, as absolute paths without links, that a search of the folder reaches by
/// symbolic links. Hidden folders are passed over, and what cannot be searched has none.
std::vector<std::filesystem::path> folders_behind_links(const std::filesystem::path& folder);

/// Returns the scans and datasets (.vtkhdf) in which objects are searched, in the same order and
/// with the same names as `find_scans`. The folders in `passed_over` are not searched, unless they
/// are inputs themselves.
FoundScans find_scenes(const std::vector<std::filesystem::path>& inputs,
                       const std::vector<std::filesystem::path>& passed_over);

}  // namespace semigeo::jobs
