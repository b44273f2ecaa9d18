#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/run_context.hpp"
#include "io/library/shape_range.hpp"

namespace semigeo::jobs {

/// A job that reads the runs of all models and writes the postings of some shapes
/// (io/library/posting_partition.hpp).
struct PartitionJob {
  std::vector<std::filesystem::path> runs;  ///< Run of each model, sorted by name.
  io::ShapeRange shapes;
  std::filesystem::path output;
  std::string key;                ///< Hash of everything the partition depends on.
  std::int64_t memory_bytes = 0;  ///< Limit for postings and buffers; 0: 512 MiB.
};

/// Describes the output of a partition job.
struct PartitionJobResult {
  std::int64_t postings = 0;
};

/// Writes the partition. Throws io::Error if a run is damaged, if the names do not ascend, or if
/// the partition cannot be written. Neither threads nor memory change the result.
PartitionJobResult run_partition_job(const PartitionJob& job, const engine::RunContext& context);

/// Returns the shapes of each partition of a library with this number of models, in order. Together
/// the partitions have every shape once. The result depends on the number of models alone, so that
/// a plan can be made before there is a run. The bytes of the library do not depend on it.
std::vector<io::ShapeRange> partition_shapes(std::int64_t models);

}  // namespace semigeo::jobs
