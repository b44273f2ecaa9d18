#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "jobs/archive/find_scans.hpp"
#include "jobs/plan/plan.hpp"
#include "jobs/stages/recognition_parameters.hpp"
#include "jobs/stages/search_parameters.hpp"

namespace semigeo::jobs {

/// The library whose models are looked for in scenes.
struct SearchedLibrary {
  std::filesystem::path path;        ///< Absolute path of its file.
  std::string digest;                ///< Digest of its content.
  std::size_t models = 0;            ///< Number of its models.
  RecognitionParameters parameters;  ///< The parameters with which it was made.
};

/// Reads the index of a library, given its file or the archive that has it. Throws io::Error if
/// there is none, or if it is damaged or made by a version that this program does not understand.
SearchedLibrary searched_library(const std::filesystem::path& file_or_archive);

/// Plans a recognise job for each scene, in their order. Each makes FOLDER/recognised/<name>.json.
/// Hashes the scenes on `threads` threads (0: one per core). Writes nothing.
std::vector<PlannedJob> plan_recognition(const std::vector<FoundScan>& scenes,
                                         const SearchedLibrary& library,
                                         const SearchParameters& parameters,
                                         const std::filesystem::path& folder, int threads);

/// Returns the folder in which a folder of results keeps its files.
std::filesystem::path recognised_folder(const std::filesystem::path& folder);
/// Returns the file about the scene of this name.
std::filesystem::path recognised_path(const std::filesystem::path& folder, const std::string& name);

/// Writes into the folder of which scenes its files are made, as record_sources does for datasets.
/// Call it before the files are made. Throws io::Error if it cannot be written.
void record_scenes(const std::filesystem::path& folder, const std::vector<PlannedJob>& plan);

}  // namespace semigeo::jobs
