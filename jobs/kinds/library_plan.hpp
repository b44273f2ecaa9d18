#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "jobs/archive/digest_cache.hpp"
#include "jobs/plan/plan.hpp"
#include "jobs/stages/recognition_parameters.hpp"

namespace semigeo::jobs {

/// The files and folders of a library.
struct LibraryPlace {
  std::filesystem::path library;
  /// Folder of the runs, and of the partitions while the library is made.
  std::filesystem::path parts;
  std::filesystem::path home;  ///< Folder that has the lock, the journal and the logs.
};

/// Returns the place of a library. ARCHIVE/library.h5 has its parts in ARCHIVE/library, and the
/// archive is its home. Any other library L has its parts in L.parts, which is its home as well.
LibraryPlace place_of(const std::filesystem::path& library);
/// Returns the place of an archive's own library.
LibraryPlace place_of_archive(const std::filesystem::path& archive);

/// A model that a library is to hold.
struct LibraryModel {
  std::string name;
  std::filesystem::path dataset = {};     ///< Empty if the run of the model stays as it is.
  std::string dataset_key = {};           ///< Key of the job that made the dataset, or will.
  std::optional<std::size_t> maker = {};  ///< Place of that job in the plan.
  std::string error = {};                 ///< Why there is no model.
};

/// Returns the models of an archive's library, sorted by name: one for each dataset that is there
/// or that the plan is going to make, whether or not its scan was named.
std::vector<LibraryModel> models_of(const std::filesystem::path& archive,
                                    const std::vector<PlannedJob>& plan, DigestCache& cache);

/// Returns the model of any dataset. Its name is that of the file without .vtkhdf.
LibraryModel model_of(const std::filesystem::path& dataset);

/// Adds the jobs that make a library to the plan: the triplets of each model, the partitions, and
/// last the library itself. Models must be sorted by name, each name once. Writes nothing.
void plan_library(std::vector<PlannedJob>& plan, const std::vector<LibraryModel>& models,
                  const LibraryPlace& place, const RecognitionParameters& parameters);

/// Reads every byte of the runs and the library that count as up to date, and plans again what is
/// damaged.
void verify_library_plan(std::vector<PlannedJob>& plan);

}  // namespace semigeo::jobs
