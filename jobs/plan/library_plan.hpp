#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "jobs/archive/digest_cache.hpp"
#include "jobs/plan/plan.hpp"

namespace semigeo::jobs {

/// Where a library is made.
struct LibraryPlace {
  std::filesystem::path library;
  std::filesystem::path parts;  ///< folder of its runs, and of partitions while it is made
  std::filesystem::path home;   ///< folder that has the lock, the journal and the logs
};

/// ARCHIVE/library.h5 has its parts in ARCHIVE/library, and the archive is its home; any other
/// library L has them in L.parts, which is its home as well.
LibraryPlace place_of(const std::filesystem::path& library);
LibraryPlace place_of_archive(const std::filesystem::path& archive);

/// A model that a library is to hold.
struct LibraryModel {
  std::string name;
  std::filesystem::path dataset = {};     ///< empty: its run stays as it is
  std::string dataset_key = {};           ///< of the job that made it, or will
  std::optional<std::size_t> maker = {};  ///< place of that job in the plan
  std::string error = {};                 ///< why there is no model
};

/// One for each dataset of the archive, and each that the plan is going to make, whether or not its
/// scan was named: a library of an archive has all of it. Sorted by name.
std::vector<LibraryModel> models_of(const std::filesystem::path& archive,
                                    const std::vector<PlannedJob>& plan, DigestCache& cache);

/// Of a dataset somewhere: its name is that of the file without .vtkhdf.
LibraryModel model_of(const std::filesystem::path& dataset);

/// Adds the jobs that make the library: triplets of each model, partitions, the library itself,
/// which comes last. Models must be sorted by name, each name once. Reads only.
void plan_library(std::vector<PlannedJob>& plan, const std::vector<LibraryModel>& models,
                  const LibraryPlace& place, const RecognitionParameters& parameters);

/// Reads every byte of the runs and the library that count as up to date, and plans again what is
/// damaged.
void verify_library_plan(std::vector<PlannedJob>& plan);

/// Removes, before jobs run, what looks up to date to those who read headers only.
void remove_damaged_parts(const std::vector<PlannedJob>& plan);

/// The models of a planned library that have no run: it does not hold them.
std::vector<std::string> missing_models(const Job& library);

/// Removes what nothing needs once the library is made: partitions, and runs of other models.
void remove_spare_parts(const Job& library);

}  // namespace semigeo::jobs
