#include "jobs/run/job_logs.hpp"

#include "jobs/plan/job_kind.hpp"

namespace semigeo::jobs {

namespace fs = std::filesystem;

fs::path log_path(const fs::path& logs, const Job& job) {
  // Names of datasets end in that of a format, or in a hash.
  const JobWords& words = job.kind->words();
  return logs / (job.name + (words.stands_for_scan ? "" : '.' + words.kind) + ".log");
}

void remove_empty_logs(const fs::path& folder) {
  std::error_code ignored;
  for (const fs::directory_entry& log : fs::directory_iterator(folder, ignored))
    if (log.path().extension() == ".log" && log.file_size(ignored) == 0)
      fs::remove(log.path(), ignored);
}

}  // namespace semigeo::jobs
