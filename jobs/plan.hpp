#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "jobs/config.hpp"

namespace semigeo::jobs {

/// A scan file and the name of its dataset in the archive.
struct FoundScan {
  std::filesystem::path input;
  std::string name;
};

/// The scans that the inputs name, in a fixed order: files as given, folders searched recursively
/// by name. Hidden files and folders, symbolic links to folders and the archive itself are passed
/// over. A name is the path relative to the folder it was found in, with the folders joined by "__"
/// and anything but letters, digits, '.', '-' and '_' replaced; names that would not be unique or
/// could be misread end in a hash of the path. It depends on nothing but that path. Throws
/// io::Error on an input that does not exist, or is a file that is no scan.
std::vector<FoundScan> find_scans(const std::vector<std::filesystem::path>& inputs,
                                  const std::filesystem::path& archive);

/// One surface job: scan in, dataset out.
struct SurfaceJob {
  std::filesystem::path input;
  std::string name;
  std::filesystem::path output;
  std::string input_xxh3;  ///< of the scan's bytes
  std::string key;         ///< hash of kind, code version, parameters, name and input_xxh3
};

struct PlannedJob {
  SurfaceJob job;
  bool up_to_date = false;
  std::string reason;  ///< why it runs; empty if it does not
  std::string error;   ///< why it cannot even be planned (the scan is unreadable)
};

/// Key under which a job's output is up to date, by content and never by time.
std::string job_key(const std::string& name, const std::string& input_xxh3,
                    const SurfaceParameters& parameters);

/// Hashes the scans and compares each key with that of the dataset in the archive. Reads only.
std::vector<PlannedJob> plan_jobs(const RunConfig& config);

}  // namespace semigeo::jobs
