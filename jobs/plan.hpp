#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "jobs/config.hpp"
#include "jobs/digest_cache.hpp"
#include "jobs/find_scans.hpp"
#include "jobs/reasons.hpp"

namespace semigeo::jobs {

/// One surface job: scan in, dataset out.
struct SurfaceJob {
  std::filesystem::path input;
  std::string input_name;  ///< what the dataset says of it: FoundScan::relative, as UTF-8
  std::string name;        ///< of the dataset
  std::filesystem::path output;
  std::string input_xxh3;  ///< of the scan's bytes
  std::string key;         ///< hash of kind, code version, parameters, name and input_xxh3
};

struct PlannedJob {
  SurfaceJob job;
  bool up_to_date = false;
  bool sidecar_only = false;    ///< it runs, but only to make the dataset's .xdmf again
  std::vector<Reason> reasons;  ///< why it runs; none if it does not
  std::string error;            ///< why it cannot even be planned (the scan is unreadable)
  std::filesystem::path scan;   ///< absolute path of the scan, for Sources
};

/// "surface <name>": what the journal and the graph call the job.
std::string job_id(const SurfaceJob& job);

/// "up to date", "would run" or "unreadable".
std::string_view state_of(const PlannedJob& planned);

/// Key under which a job's output is up to date, by content and never by time.
std::string job_key(const std::string& name, const std::string& input_xxh3,
                    const SurfaceParameters& parameters);

/// Hashes the scans and compares each key with that of the dataset in the archive. Reads only, and
/// of what the cache knows not even that.
std::vector<PlannedJob> plan_jobs(const RunConfig& config, const std::vector<FoundScan>& scans,
                                  DigestCache& cache);
/// Of all scans that the configuration names, without the help of a cache.
std::vector<PlannedJob> plan_jobs(const RunConfig& config);

/// Reads every array of the datasets that count as up to date, as verify_datasets does, and plans
/// again what is damaged.
void verify_plan(std::vector<PlannedJob>& plan, int at_once);

/// Tells the archive, which must exist, of which scans its datasets are made. Do it before they
/// are.
void record_sources(const std::filesystem::path& archive, const std::vector<PlannedJob>& plan);

}  // namespace semigeo::jobs
