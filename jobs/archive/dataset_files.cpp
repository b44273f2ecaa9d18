#include "jobs/archive/dataset_files.hpp"

#include <algorithm>
#include <system_error>

#include "io/files/read_error.hpp"

namespace semigeo::jobs {

namespace fs = std::filesystem;

std::vector<fs::path> files_with_extension(const fs::path& folder, std::string_view extension) {
  std::vector<fs::path> files;
  if (!io::is_there(folder)) return files;
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  for (const fs::directory_iterator end; !error && entry != end; entry.increment(error)) {
    const fs::path& path = entry->path();
    if (path.extension() == extension && !path.filename().string().starts_with('.'))
      files.push_back(path);
  }
  if (error) throw io::open_error(folder, error.value());
  std::ranges::sort(files);
  return files;
}

std::vector<fs::path> dataset_files(const fs::path& folder) {
  return files_with_extension(folder, ".vtkhdf");
}

}  // namespace semigeo::jobs
