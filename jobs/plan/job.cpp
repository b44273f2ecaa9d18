#include "jobs/plan/job.hpp"

#include "io/files/read_error.hpp"
#include "jobs/archive/names.hpp"
#include "jobs/plan/job_kind.hpp"

namespace semigeo::jobs {

namespace fs = std::filesystem;

std::string job_id(const Job& job) {
  return job.kind->words().kind + ' ' + job.name;
}

std::string shown_name(const Job& job) {
  return job.kind->words().stands_for_scan ? given_name(job.input, job.name) : job_id(job);
}

const fs::path& subject_of(const Job& job) {
  return job.kind->words().merges_files ? job.output : job.input;
}

std::string output_key(const Job& job, KeyCheck check) {
  return output_key(*job.kind, job.output, check);
}

std::string output_key(const JobKind& kind, const fs::path& output, KeyCheck check) {
  if (!io::is_there(output)) return "";
  try {
    return kind.read_key(output, check);
  } catch (const io::ReadError& error) {
    if (!error.is_absent()) throw;
  } catch (const io::Error&) {
  }
  return "";
}

bool is_complete(const Job& job) {
  return !job.key.empty() && job.kind->has_all_outputs(job) && output_key(job) == job.key;
}

}  // namespace semigeo::jobs
