#include "jobs/plan/job_inputs.hpp"

#include <utility>
#include <vector>

#include "io/dataset/dataset.hpp"
#include "io/files/error.hpp"
#include "jobs/plan/job_key.hpp"

namespace semigeo::jobs {

namespace fs = std::filesystem;

const std::string& JobInputs::key_of_run(const fs::path& run) {
  const auto [at, is_new] = run_keys_.try_emplace(run);
  // Planning has read those that were there, and the others have been written just now.
  if (is_new)
    at->second = output_key_in_head(
        {.kind = JobKind::kTriplets, .name = {}, .input = {}, .output = run, .key = {}});
  return at->second;
}

bool JobInputs::settle(Job& job) {
  switch (job.kind) {
    case JobKind::kSurface:
    case JobKind::kRecognise:
      break;
    case JobKind::kTriplets:
      job.key.clear();
      job.key = triplets_key(job.name, io::read_origin(job.input).job_key, parameters_);
      break;
    case JobKind::kPartition:
    case JobKind::kLibrary:
      return settle_models(job);
  }
  return is_complete(job);
}

bool JobInputs::settle_models(Job& job) {
  std::vector<std::string> models;
  std::vector<std::string> keys;
  for (std::string& model : job.models) {
    const std::string& key = key_of_run(run_path(job.input, model));
    if (key.empty()) continue;
    models.push_back(std::move(model));
    keys.push_back(key);
  }
  job.models = std::move(models);
  if (job.models.empty())
    throw io::Error(job.output, "", "there is no model to make it of",
                    "see why the jobs before it failed, and run again");
  Job library = job;
  library.kind = JobKind::kLibrary;
  library.key = library_key(keys, parameters_);
  if (job.kind == JobKind::kPartition) {
    library.output = job.library;
    job.key = partition_key(keys, job.shapes);
    return is_complete(job) || is_complete(library);
  }
  job.key = library.key;
  if (is_complete(job)) return true;
  std::error_code ignored;
  for (int number = 0; number < job.partitions; ++number) {
    const fs::path partition = partition_path(job.input, number);
    if (!fs::exists(partition, ignored))
      throw io::Error(partition, "", "is missing: " + job.name + " is made of it",
                      "see why its job failed, and run again");
  }
  return false;
}

void remove_stale_run(const Job& job) {
  std::error_code ignored;
  if (job.kind == JobKind::kTriplets && !is_complete(job)) fs::remove(job.output, ignored);
}

}  // namespace semigeo::jobs
