#pragma once

#include <filesystem>
#include <vector>

#include "jobs/kinds/library_plan.hpp"
#include "jobs/plan/plan.hpp"

namespace semigeo::jobs {

/// Returns the folder in which an archive has its report.
std::filesystem::path report_folder(const std::filesystem::path& archive);

/// Says where a report is made, and how much of it.
struct ReportPlace {
  std::filesystem::path archive;
  std::filesystem::path folder;  ///< Folder of the pages.
  bool index_only = false;       ///< There are no pages of single scans.
};

/// Adds the jobs that make a report to the plan: a page for each dataset, a page for each
/// recognised scene, and last the first page. `datasets` are those that are there or that the plan
/// is going to make (models_of). The first page waits for all jobs of the plan, and is made again
/// if one of them runs. Throws io::Error if the folder is no archive, or its journal or
/// sources.json cannot be read. Writes nothing.
void plan_report(std::vector<PlannedJob>& plan, const std::vector<LibraryModel>& datasets,
                 const ReportPlace& place);

}  // namespace semigeo::jobs
