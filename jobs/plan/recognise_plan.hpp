#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "jobs/archive/find_scans.hpp"
#include "jobs/plan/config.hpp"
#include "jobs/plan/plan.hpp"

namespace semigeo::jobs {

/// A library in which scenes are to be looked for.
struct SearchedLibrary {
  std::filesystem::path path;  ///< absolute
  std::string digest;          ///< of its content
  std::size_t models = 0;
  RecognitionParameters parameters;  ///< with which it was made
};

/// Of a library's file, or of the archive that has one. Reads its index. io::Error if there is
/// none, or it is damaged or made by a version that this program does not understand.
SearchedLibrary searched_library(const std::filesystem::path& file_or_archive);

/// Recognition jobs, in the order of the scenes; each makes FOLDER/recognised/<name>.json. Hashes
/// the scenes on so many threads (0: one per core). Reads only.
std::vector<PlannedJob> plan_recognition(const std::vector<FoundScan>& scenes,
                                         const SearchedLibrary& library,
                                         const SearchParameters& parameters,
                                         const std::filesystem::path& folder, int threads);

/// Tells the folder of which scenes its files are, as record_sources does of datasets. Do it before
/// they are made.
void record_scenes(const std::filesystem::path& folder, const std::vector<PlannedJob>& plan);

}  // namespace semigeo::jobs
