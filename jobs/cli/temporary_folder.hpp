#pragma once

#include <filesystem>

namespace semigeo::jobs::cli {

/// A folder for files that are not kept. The destructor removes it with its content.
class TemporaryFolder {
 public:
  /// Makes the folder. Throws io::Error if it cannot be made.
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace semigeo::jobs::cli
