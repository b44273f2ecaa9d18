#pragma once

#include <filesystem>
#include <vector>

namespace semigeo::jobs {

/// Returns the datasets (*.vtkhdf) in a folder, by name, without hidden files, which are
/// unfinished. A folder that does not exist holds none. Throws std::filesystem::filesystem_error if
/// the folder cannot be read.
std::vector<std::filesystem::path> dataset_files(const std::filesystem::path& folder);

}  // namespace semigeo::jobs
