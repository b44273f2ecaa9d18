#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "jobs/config.hpp"

namespace semigeo::jobs {

/// A scan file, or a folder in which scans cannot be looked for.
struct FoundScan {
  std::filesystem::path input;
  std::string relative;        ///< path below the folder it was found in, or its file name
  std::string name;            ///< of its dataset, unless a scan of another folder has it
  std::filesystem::path file;  ///< absolute; the same for every path to one file
  std::string error;           ///< of a folder: why it cannot be searched
};

/// The scans that the inputs name, in a fixed order: files as given, folders searched recursively
/// by name. Hidden files and folders, symbolic links to folders and the archive itself are passed
/// over. A name is the path relative to the folder it was found in, with the folders joined by "__"
/// and anything but letters, digits, '.', '-' and '_' replaced; names that could be misread end in
/// a hash of the path. It depends on nothing but that path. Throws io::Error on an input that does
/// not exist or cannot be searched, or is a file that is no scan.
std::vector<FoundScan> find_scans(const std::vector<std::filesystem::path>& inputs,
                                  const std::filesystem::path& archive);

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
  bool sidecar_only = false;   ///< it runs, but only to make the dataset's .xdmf again
  std::string reason;          ///< why it runs; empty if it does not
  std::string error;           ///< why it cannot even be planned (the scan is unreadable)
  std::filesystem::path scan;  ///< absolute path of the scan, for Sources
};

/// Key under which a job's output is up to date, by content and never by time.
std::string job_key(const std::string& name, const std::string& input_xxh3,
                    const SurfaceParameters& parameters);

/// Hashes the scans and compares each key with that of the dataset in the archive. Reads only.
std::vector<PlannedJob> plan_jobs(const RunConfig& config, const std::vector<FoundScan>& scans);
/// Of all scans that the configuration names.
std::vector<PlannedJob> plan_jobs(const RunConfig& config);

/// Reads every array of the datasets that count as up to date, as verify_datasets does, and plans
/// again what is damaged.
void verify_plan(std::vector<PlannedJob>& plan, int at_once);

/// Tells the archive, which must exist, of which scans its datasets are made. Do it before they
/// are.
void record_sources(const std::filesystem::path& archive, const std::vector<PlannedJob>& plan);

}  // namespace semigeo::jobs
