#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "jobs/archive/estimates.hpp"
#include "jobs/plan/output_keys.hpp"

namespace semigeo::jobs {

// What partition and library jobs share: both merge the runs of many models.

/// Keeps those of `models` whose runs are in the folder of parts, and returns the keys of their
/// runs. Throws io::Error that names `output` if there is none.
std::vector<std::string> keep_models_with_runs(std::vector<std::string>& models,
                                               const std::filesystem::path& parts,
                                               const std::filesystem::path& output,
                                               OutputKeys& keys);

/// Returns the paths of the models' runs.
std::vector<std::filesystem::path> run_paths(const std::filesystem::path& parts,
                                             const std::vector<std::string>& models);

/// Returns the bytes that a merging job may take for postings and buffers when all jobs that run
/// side by side have `memory_bytes`; 0: the user gave no limit.
std::int64_t buffer_bytes(std::uint64_t memory_bytes);

/// Returns what a job that merges one of `shares` equal shares of all triplets is expected to need.
Estimate merging_estimate(std::size_t models, int shares, std::uint64_t memory_bytes);

}  // namespace semigeo::jobs
