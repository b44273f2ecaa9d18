#include "jobs/archive/links.hpp"

#include "io/files/error.hpp"

namespace semigeo::jobs {

namespace fs = std::filesystem;

void refuse_links(const fs::path& home) {
  for (const char* name :
       {"scans", "logs", "library", "library/triplets", "library/partitions", "triplets",
        "partitions", "recognised", "report", "report/scans", "report/scenes", "slurm"}) {
    const fs::path folder = home / name;
    std::error_code ignored;
    if (fs::is_symlink(fs::symlink_status(folder, ignored)))
      throw io::Error(folder, "", "is a symbolic link, behind which nothing is written or removed",
                      "put the folder itself in its place, or give the folder of the whole archive "
                      "as a link");
  }
}

}  // namespace semigeo::jobs
