#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace semigeo::jobs {

/// A scan file, or a folder in which scans cannot be looked for.
struct FoundScan {
  std::filesystem::path input;
  std::string relative;        ///< path below the folder it was found in, or its file name
  std::string name;            ///< of its dataset, unless a scan of another folder has it
  std::filesystem::path file;  ///< absolute; the same for every path to one file
  std::string error;           ///< of a folder: why it cannot be searched
};

/// The scans that the inputs name, in a fixed order: files as given, folders searched recursively
/// by name. Hidden files and folders, symbolic links to folders and the archive itself are passed
/// over. A name is the path relative to the folder it was found in, with the folders joined by "__"
/// and anything but letters, digits, '.', '-' and '_' replaced; names that could be misread end in
/// a hash of the path. It depends on nothing but that path. Throws io::Error on an input that does
/// not exist or cannot be searched, or is a file that is no scan.
std::vector<FoundScan> find_scans(const std::vector<std::filesystem::path>& inputs,
                                  const std::filesystem::path& archive);

/// Likewise the scans and datasets (.vtkhdf) in which objects are looked for. Folders `passed_over`
/// are not searched, unless they are inputs themselves.
std::vector<FoundScan> find_scenes(const std::vector<std::filesystem::path>& inputs,
                                   const std::vector<std::filesystem::path>& passed_over);

}  // namespace semigeo::jobs
