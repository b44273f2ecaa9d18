#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/run_context.hpp"

namespace semigeo::jobs {

/// Runs and partitions in, library.h5 out (io/library/hash_library.hpp).
struct LibraryJob {
  std::vector<std::filesystem::path> runs;        ///< as the partitions had them
  std::vector<std::filesystem::path> partitions;  ///< in the order of their shapes
  nlohmann::json parameters;                      ///< with which the runs were made
  std::filesystem::path output;
  std::string key;                ///< hash of everything the library depends on
  std::int64_t memory_bytes = 0;  ///< for postings and buffers, at most; 0: 512 MiB
};

struct LibraryJobResult {
  std::int64_t models = 0;
  std::int64_t postings = 0;
  std::string digest;
};

/// Throws io::Error on damaged runs or partitions, on partitions that are not of these runs or do
/// not have every shape once, and when the library cannot be written. Neither threads nor memory
/// change the result.
LibraryJobResult run_library_job(const LibraryJob& job, const engine::RunContext& context);

}  // namespace semigeo::jobs
