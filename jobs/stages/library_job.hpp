#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/run_context.hpp"

namespace semigeo::jobs {

/// A job that reads runs and partitions and writes a library (io/library/hash_library.hpp).
struct LibraryJob {
  std::vector<std::filesystem::path> runs;        ///< The runs that the partitions were made of.
  std::vector<std::filesystem::path> partitions;  ///< Partitions in the order of their shapes.
  nlohmann::json parameters;                      ///< The parameters that the runs were made with.
  std::filesystem::path output;
  std::string key;                ///< Hash of everything the library depends on.
  std::int64_t memory_bytes = 0;  ///< Limit for postings and buffers; 0: 512 MiB.
};

/// Describes the output of a library job.
struct LibraryJobResult {
  std::int64_t models = 0;
  std::int64_t postings = 0;
  std::string digest;
};

/// Writes the library. Throws io::Error if a run or a partition is damaged, if the partitions were
/// made of other runs or do not have every shape once, or if the library cannot be written. Neither
/// threads nor memory change the result.
LibraryJobResult run_library_job(const LibraryJob& job, const engine::RunContext& context);

}  // namespace semigeo::jobs
