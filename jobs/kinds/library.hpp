#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "jobs/plan/job_kind.hpp"
#include "jobs/stages/recognition_parameters.hpp"

namespace semigeo::jobs {

/// The data of a library job, which makes a hash library of runs and partitions. The input of the
/// job is the folder of the library's parts.
struct LibraryJobData {
  std::vector<std::string> models = {};  ///< Names of all models, sorted.
  int partitions = 0;                    ///< Number of partitions.
  RecognitionParameters parameters = {};
};

/// The kind whose jobs make one hash library (jobs/stages/library_job.hpp). The data of its jobs is
/// a LibraryJobData, their result a LibraryJobResult.
const JobKind& library_kind();

/// Returns the job that makes a library. `run_keys` are the keys of the models' runs.
Job library_job(LibraryJobData data, const std::filesystem::path& library,
                const std::filesystem::path& parts, std::span<const std::string> run_keys);

/// Returns the key of the library of these runs, in the order of the names of their models.
std::string library_key(std::span<const std::string> run_keys,
                        const RecognitionParameters& parameters);

/// Returns the models that a planned library was to have and does not hold. If it was not made,
/// those that have no run.
std::vector<std::string> missing_models(const Job& library, JobState state);

}  // namespace semigeo::jobs
