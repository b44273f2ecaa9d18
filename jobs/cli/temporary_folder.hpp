#pragma once

#include <filesystem>

namespace semigeo::jobs::cli {

/// A folder for what nobody wants to keep; removed with everything in it.
class TemporaryFolder {
 public:
  /// Throws io::Error if there can be none.
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace semigeo::jobs::cli
