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
  // No later run would find it, so what fails once is tried again.
  std::error_code error;
  for (int tries = 0; tries < 3; ++tries) {
    fs::remove_all(path_, error);
    if (!error) return;
  }
}

}  // namespace semigeo::jobs::cli
