#include "jobs/cli/datasets.hpp"

#include "io/files/read_error.hpp"
#include "jobs/archive/dataset_files.hpp"

namespace semigeo::jobs::cli {

std::vector<std::filesystem::path> datasets_at(const std::filesystem::path& file_or_archive) {
  namespace fs = std::filesystem;
  if (!io::is_there(file_or_archive))
    throw io::Error(file_or_archive, "", "no such file or folder", "check the path");
  if (!io::is_folder(file_or_archive)) return {file_or_archive};

  const fs::path scans = file_or_archive / "scans";
  std::vector<fs::path> datasets = dataset_files(io::is_folder(scans) ? scans : file_or_archive);
  if (datasets.empty())
    throw io::Error(file_or_archive, "", "holds no dataset (scans/*.vtkhdf)",
                    "make some: semigeo run SCANS --output " + file_or_archive.string());
  return datasets;
}

}  // namespace semigeo::jobs::cli
