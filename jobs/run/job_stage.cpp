#include "jobs/run/job_stage.hpp"

#include <vector>

#include "jobs/plan/job_key.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> runs_of(const Job& job) {
  std::vector<fs::path> runs;
  for (const std::string& model : job.models) runs.push_back(run_path(job.input, model));
  return runs;
}

std::vector<fs::path> partitions_of(const Job& job) {
  std::vector<fs::path> partitions;
  for (int number = 0; number < job.partitions; ++number)
    partitions.push_back(partition_path(job.input, number));
  return partitions;
}

}  // namespace

JobResult run_stage(const Job& job, const JobParameters& parameters,
                    const engine::RunContext& context) {
  switch (job.kind) {
    case JobKind::kSurface:
      return run_surface_job({.input = job.input,
                              .input_name = job.input_name,
                              .name = job.name,
                              .output = job.output,
                              .input_xxh3 = job.input_xxh3,
                              .key = job.key},
                             parameters.surface, context);
    case JobKind::kTriplets:
      return run_triplets_job({.dataset = job.input,
                               .name = job.name,
                               .output = job.output,
                               .key_of =
                                   [&](const std::string& dataset_key) {
                                     return triplets_key(job.name, dataset_key,
                                                         parameters.recognition);
                                   }},
                              parameters.recognition, context);
    case JobKind::kPartition:
      return run_partition_job({.runs = runs_of(job),
                                .shapes = job.shapes,
                                .output = job.output,
                                .key = job.key,
                                .memory_bytes = job.buffer_bytes},
                               context);
    case JobKind::kLibrary:
      return run_library_job({.runs = runs_of(job),
                              .partitions = partitions_of(job),
                              .parameters = json_of(parameters.recognition),
                              .output = job.output,
                              .key = job.key,
                              .memory_bytes = job.buffer_bytes},
                             context);
    case JobKind::kRecognise:
      break;
  }
  return run_recognise_job({.scene = job.input,
                            .input_name = job.input_name,
                            .name = job.name,
                            .input_xxh3 = job.input_xxh3,
                            .library = job.library,
                            .library_digest = job.library_digest,
                            .output = job.output,
                            .key = job.key},
                           parameters.search, context);
}

}  // namespace semigeo::jobs
