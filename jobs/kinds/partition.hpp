#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/library/shape_range.hpp"
#include "jobs/plan/job_kind.hpp"
#include "jobs/stages/recognition_parameters.hpp"

namespace semigeo::jobs {

/// The data of a partition job, which makes the postings of some shapes of the runs of all models.
/// The input of the job is the folder of the library's parts.
struct PartitionJobData {
  std::vector<std::string> models = {};  ///< Names of all models, sorted.
  io::ShapeRange shapes = {};
  int partitions = 1;                  ///< Number of partitions that share the triplets.
  std::filesystem::path library = {};  ///< The library that the partition is a part of.
  RecognitionParameters parameters = {};
};

/// The kind whose jobs make one partition of the runs of all models
/// (jobs/stages/partition_job.hpp). The data of its jobs is a PartitionJobData, their result a
/// PartitionJobResult.
const JobKind& partition_kind();

/// Returns the job that makes partition `number`. `run_keys` are the keys of the models' runs.
Job partition_job(int number, PartitionJobData data, const std::filesystem::path& parts,
                  std::span<const std::string> run_keys);

/// Returns where the folder of a library's parts has the partition of this number.
std::filesystem::path partition_path(const std::filesystem::path& parts, int number);

/// Returns the key of the partition that has these shapes of these runs, in the order of the names
/// of their models.
std::string partition_key(std::span<const std::string> run_keys, const io::ShapeRange& shapes);

}  // namespace semigeo::jobs
