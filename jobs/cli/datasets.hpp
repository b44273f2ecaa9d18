#pragma once

#include <filesystem>
#include <vector>

namespace semigeo::jobs::cli {

/// Returns the datasets that FILE or ARCHIVE names: the file itself, or every *.vtkhdf in the
/// archive's scans/ (or in the folder itself), by name. Throws io::Error if there is none.
std::vector<std::filesystem::path> datasets_at(const std::filesystem::path& file_or_archive);

}  // namespace semigeo::jobs::cli
