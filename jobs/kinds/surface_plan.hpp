#pragma once

#include <filesystem>
#include <vector>

#include "jobs/archive/digest_cache.hpp"
#include "jobs/archive/find_scans.hpp"
#include "jobs/plan/plan.hpp"
#include "jobs/stages/surface_parameters.hpp"

namespace semigeo::jobs {

/// Plans a surface job for each scan: hashes the scans on `threads` threads (0: one per core) and
/// compares each key with that of the dataset in the archive. Writes nothing, and reads no file
/// whose digest the cache knows.
std::vector<PlannedJob> plan_surfaces(const std::filesystem::path& archive,
                                      const std::vector<FoundScan>& scans,
                                      const SurfaceParameters& parameters, DigestCache& cache,
                                      int threads);

/// Reads every array of the datasets that count as up to date, `at_once` datasets at a time, as
/// verify_datasets does, and plans again what is damaged. Passes over jobs of other kinds.
void verify_surfaces(std::vector<PlannedJob>& plan, int at_once);

/// Writes into the archive, which must exist, of which scans its datasets are made. Call it before
/// the datasets are made. Throws io::Error if it cannot be written.
void record_sources(const std::filesystem::path& archive, const std::vector<PlannedJob>& plan);

}  // namespace semigeo::jobs
