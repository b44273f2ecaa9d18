#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace semigeo::jobs {

/// The version of what the first page shows. It is part of the page's key.
inline constexpr std::string_view kIndexVersion = "index 2";

/// Returns what the first page of the report shows of an archive, from its datasets, its journal,
/// its recognised files and sources.json:
///
///   archive   name of its folder
///   run       the last run that did something besides making pages (jobs/report/run_figures.hpp),
///             and its state
///   failures  jobs of that run that failed, and datasets that cannot be read, each with a reason
///             and, if there is one, a remedy
///   scans     a record for each scan that has a dataset, is known by sources.json or failed in the
///             last run. Failures come first, then names in order. Values that are not known are
///             absent.
///   scenes    a record for each recognised file, with the models that were found
///   unread    a sentence for each dataset and recognised file that the system refused to read and
///             that may be whole
///
/// `folder` is that of the report: what has a page in it has the address of the page. Time and
/// memory are those of the last job that made the dataset. Reads attributes and the sizes of level
/// 0 and of the level of recognition: some milliseconds for each dataset. Throws io::Error if the
/// folder is no archive, or its journal or sources.json cannot be read.
nlohmann::json archive_report(const std::filesystem::path& archive,
                              const std::filesystem::path& folder);

/// Returns a hash of the keys of all that `archive_report` shows. Reads a few kB of each dataset
/// and the journal. The text is empty if the system refuses to read something. Throws other errors
/// as `archive_report` does.
std::string archive_digest(const std::filesystem::path& archive,
                           const std::filesystem::path& folder);

/// Returns the names of the scenes about which an archive has a recognised file, sorted.
std::vector<std::string> scene_names(const std::filesystem::path& archive);

}  // namespace semigeo::jobs
