#include "jobs/plan/job.hpp"

#include <cstdio>

#include "io/dataset/dataset.hpp"
#include "io/dataset/xdmf.hpp"
#include "io/files/error.hpp"
#include "io/library/hash_library.hpp"
#include "io/library/posting_partition.hpp"
#include "io/library/triplet_run.hpp"
#include "jobs/stages/recognised_file.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

std::string read_key(const Job& job, bool whole) {
  switch (job.kind) {
    case JobKind::kSurface:
      return io::read_origin(job.output).job_key;
    case JobKind::kTriplets:
      return whole ? io::triplet_run_key(job.output) : io::TripletRun(job.output).job_key();
    case JobKind::kPartition:
      return io::posting_partition_key(job.output);
    case JobKind::kLibrary:
      return io::library_key(job.output);
    case JobKind::kRecognise:
      break;
  }
  return recognised_key(job.output);
}

std::string key_of(const Job& job, bool whole) {
  std::error_code ignored;
  if (!fs::exists(job.output, ignored)) return "";
  try {
    return read_key(job, whole);
  } catch (const io::Error&) {
    return "";
  }
}

}  // namespace

std::string_view name_of(JobKind kind) {
  switch (kind) {
    case JobKind::kSurface:
      return "surface";
    case JobKind::kTriplets:
      return "triplets";
    case JobKind::kPartition:
      return "partition";
    case JobKind::kLibrary:
      return "library";
    case JobKind::kRecognise:
      break;
  }
  return "recognise";
}

std::string_view output_name_of(JobKind kind) {
  switch (kind) {
    case JobKind::kSurface:
      return "dataset";
    case JobKind::kTriplets:
      return "run";
    case JobKind::kPartition:
      return "postings";
    case JobKind::kLibrary:
      return "hash library";
    case JobKind::kRecognise:
      break;
  }
  return "recognition";
}

std::string job_id(const Job& job) {
  return std::string(name_of(job.kind)) + ' ' + job.name;
}

const fs::path& subject_of(const Job& job) {
  const bool of_many = job.kind == JobKind::kPartition || job.kind == JobKind::kLibrary;
  return of_many ? job.output : job.input;
}

fs::path run_path(const fs::path& parts, const std::string& model) {
  return parts / "triplets" / (model + ".run");
}

fs::path partition_path(const fs::path& parts, int number) {
  char name[16];
  std::snprintf(name, sizeof name, "%03d.part", number);
  return parts / "partitions" / name;
}

std::string output_key(const Job& job) {
  return key_of(job, true);
}

std::string output_key_in_head(const Job& job) {
  return key_of(job, false);
}

bool is_complete(const Job& job) {
  std::error_code ignored;
  if (job.kind == JobKind::kSurface && !fs::exists(io::sidecar_of(job.output), ignored))
    return false;
  return !job.key.empty() && output_key(job) == job.key;
}

}  // namespace semigeo::jobs
