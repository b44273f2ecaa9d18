#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/run_context.hpp"
#include "io/library/shape_range.hpp"

namespace semigeo::jobs {

/// Runs of all models in, the postings of some shapes out (io/library/posting_partition.hpp).
struct PartitionJob {
  std::vector<std::filesystem::path> runs;  ///< model i of the library is runs[i]: sorted by name
  io::ShapeRange shapes;
  std::filesystem::path output;
  std::string key;                ///< hash of everything the partition depends on
  std::int64_t memory_bytes = 0;  ///< for postings and buffers, at most; 0: 512 MiB
};

struct PartitionJobResult {
  std::int64_t postings = 0;
};

/// Throws io::Error on a damaged run, on names that do not ascend, and when the partition cannot be
/// written. Neither threads nor memory change the result.
PartitionJobResult run_partition_job(const PartitionJob& job, const engine::RunContext& context);

/// The partitions of a library of so many models, in order; together they have every shape once.
/// It depends on nothing else, so that a plan can be made before there is a run; whatever it is,
/// the library is the same, byte by byte.
std::vector<io::ShapeRange> partition_shapes(std::int64_t models);

}  // namespace semigeo::jobs
