#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace semigeo::jobs {

/// Returns the files with this extension in a folder, by name, without hidden files, which are
/// unfinished. A folder that does not exist holds none. Throws io::ReadError if the folder cannot
/// be read.
std::vector<std::filesystem::path> files_with_extension(const std::filesystem::path& folder,
                                                        std::string_view extension);

/// Returns the datasets (*.vtkhdf) in a folder, in the same way.
std::vector<std::filesystem::path> dataset_files(const std::filesystem::path& folder);

}  // namespace semigeo::jobs
