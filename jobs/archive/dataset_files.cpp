#include "jobs/archive/dataset_files.hpp"

#include <algorithm>

namespace semigeo::jobs {

std::vector<std::filesystem::path> dataset_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> datasets;
  if (!std::filesystem::exists(folder)) return datasets;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".vtkhdf" && !entry.path().filename().string().starts_with('.'))
      datasets.push_back(entry.path());
  std::sort(datasets.begin(), datasets.end());
  return datasets;
}

}  // namespace semigeo::jobs
