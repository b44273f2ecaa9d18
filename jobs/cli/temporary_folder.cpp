#include "jobs/cli/temporary_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "io/files/error.hpp"

namespace semigeo::jobs::cli {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  const fs::path where = fs::temp_directory_path(error);
  std::string name = (error ? fs::path("/tmp") : where) / "semigeo-XXXXXX";
  if (mkdtemp(name.data()) == nullptr)
    throw io::Error(name, "", std::string("cannot be created: ") + std::strerror(errno),
                    "set TMPDIR to a folder that can be written");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace semigeo::jobs::cli
