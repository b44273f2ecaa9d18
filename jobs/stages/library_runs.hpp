#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "engine/parallel.hpp"
#include "io/triplet_run.hpp"

namespace semigeo::jobs {

/// Calls use(i, run) for each run, on any thread and in any order, and returns io::runs_hash of
/// all. Error unless the names of their models ascend.
std::uint64_t for_each_run(const std::vector<std::filesystem::path>& runs, engine::Workers& workers,
                           const std::function<void(std::size_t, const io::TripletRun&)>& use);

/// Cuts [0, sizes.size()) into consecutive ranges whose sizes add up to `capacity` at most, or that
/// hold one index alone.
std::vector<engine::IndexRange> batches_of(std::span<const std::int64_t> sizes,
                                           std::int64_t capacity);

/// What PartitionJob and LibraryJob mean by their memory_bytes: 512 MiB by 0.
std::int64_t memory_or_default(std::int64_t memory_bytes);

}  // namespace semigeo::jobs
