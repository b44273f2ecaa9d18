#pragma once

#include <cstdint>
#include <vector>

#include "jobs/archive/estimates.hpp"
#include "jobs/plan/plan.hpp"

namespace semigeo::jobs {

/// What each job of a plan is expected to need, on one thread; nothing for what does not run.
/// `memory_bytes`: of all jobs of a machine, 0 if it is not told; partitions and libraries are
/// content with less.
std::vector<Estimate> estimates_of(const std::vector<PlannedJob>& plan,
                                   const JobParameters& parameters, const Estimates& estimates,
                                   std::uint64_t memory_bytes);

/// What a partition or library job may take for postings and buffers, of so much memory.
std::int64_t buffer_bytes(std::uint64_t memory_bytes);

}  // namespace semigeo::jobs
