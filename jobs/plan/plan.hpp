#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "jobs/archive/digest_cache.hpp"
#include "jobs/archive/find_scans.hpp"
#include "jobs/plan/config.hpp"
#include "jobs/plan/job.hpp"
#include "jobs/plan/reasons.hpp"

namespace semigeo::jobs {

/// A job and what is known of it before anything runs.
struct PlannedJob {
  Job job;
  std::vector<std::size_t> after = {};  ///< places in the plan, before its own: of jobs that make
                                        ///< what it reads. When they have ended, it may begin
  bool up_to_date = false;
  bool inputs_are_there = false;  ///< no look at them again when it begins: its key stands
  bool sidecar_only = false;      ///< it runs, but only to make the dataset's .xdmf again
  std::vector<Reason> reasons;    ///< why it runs; none if it does not
  std::string error;              ///< why it cannot even be planned (the scan is unreadable)
  std::filesystem::path scan;     ///< surface: absolute path of the scan, for Sources
};

/// "up to date", "would run" or "unreadable".
std::string_view state_of(const PlannedJob& planned);

/// Surface jobs: hashes the scans and compares each key with that of the dataset in the archive.
/// Reads only, and of what the cache knows not even that.
std::vector<PlannedJob> plan_jobs(const RunConfig& config, const std::vector<FoundScan>& scans,
                                  DigestCache& cache);
/// Of all scans that the configuration names, without the help of a cache.
std::vector<PlannedJob> plan_jobs(const RunConfig& config);

/// Reads every array of the datasets that count as up to date, as verify_datasets does, and plans
/// again what is damaged. Of surface jobs; other kinds are passed over.
void verify_plan(std::vector<PlannedJob>& plan, int at_once);

/// Compares what is there, by its key, with what the job would make. Of all kinds but surface jobs.
void judge_output(PlannedJob& planned, std::string (*key_of)(const Job&) = output_key);

/// Tells the archive, which must exist, of which scans its datasets are made. Do it before they
/// are.
void record_sources(const std::filesystem::path& archive, const std::vector<PlannedJob>& plan);

}  // namespace semigeo::jobs
