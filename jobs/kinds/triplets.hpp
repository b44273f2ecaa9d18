#pragma once

#include <filesystem>
#include <string>

#include "jobs/plan/job_kind.hpp"
#include "jobs/stages/recognition_parameters.hpp"

namespace semigeo::jobs {

/// The data of a triplets job, which makes a run, the triplets of one model, of a dataset.
struct TripletsJobData {
  RecognitionParameters parameters = {};
};

/// The kind whose jobs make one run of one dataset (jobs/stages/triplets_job.hpp). The data of its
/// jobs is a TripletsJobData, their result a TripletsJobResult.
const JobKind& triplets_kind();

/// Returns the job that makes the run of a model. `dataset_key` is the key of the job that made its
/// dataset, or will.
Job triplets_job(const std::string& model, const std::filesystem::path& dataset,
                 const std::string& dataset_key, const std::filesystem::path& parts,
                 const RecognitionParameters& parameters);

/// Returns where the folder of a library's parts has the run of a model.
std::filesystem::path run_path(const std::filesystem::path& parts, const std::string& model);

/// Returns the key of the run of a model that is made of the dataset with this key.
std::string triplets_key(const std::string& model, const std::string& dataset_key,
                         const RecognitionParameters& parameters);

}  // namespace semigeo::jobs
