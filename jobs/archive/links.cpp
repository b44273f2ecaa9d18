#include "jobs/archive/links.hpp"

#include "io/files/read_error.hpp"

namespace semigeo::jobs {

namespace fs = std::filesystem;

void refuse_links(const fs::path& home) {
  for (const char* name :
       {"scans", "logs", "library", "library/triplets", "library/partitions", "triplets",
        "partitions", "recognised", "report", "report/scans", "report/scenes", "slurm"}) {
    const fs::path folder = home / name;
    std::error_code error;
    const fs::file_status status = fs::symlink_status(folder, error);
    if (status.type() == fs::file_type::none) throw io::open_error(folder, error.value());
    if (fs::is_symlink(status))
      throw io::Error(folder, "", "is a symbolic link, behind which nothing is written or removed",
                      "put the folder itself in its place, or give the folder of the whole archive "
                      "as a link");
  }
}

}  // namespace semigeo::jobs
