#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace semigeo::jobs {

/// Returns what the first page of the report shows of an archive, from its datasets, its journal
/// and sources.json:
///
///   archive   name of its folder
///   run       the last run: state, start, seconds, vertex levels per second
///   failures  jobs of the last run that failed, and datasets that cannot be read, each with a
///             reason and, if there is one, a remedy
///   scans     a record for each scan that has a dataset, is known by sources.json or failed in the
///             last run. Failures come first, then names in order. Values that are not known are
///             absent.
///
/// Time and memory are those of the last job that made the dataset. Reads attributes and the sizes
/// of level 0 and of the level of recognition: some milliseconds for each dataset. Throws io::Error
/// if the folder is no archive, or its journal or sources.json cannot be read.
nlohmann::json archive_report(const std::filesystem::path& archive);

}  // namespace semigeo::jobs
