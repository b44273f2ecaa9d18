#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "jobs/plan/job_kind.hpp"

namespace semigeo::jobs {

/// The data of a job that makes the page of a scan. Its head says all.
struct PageJobData {};

/// The data of a job that makes the page of a recognised scene.
struct SceneJobData {
  std::filesystem::path scene = {};  ///< The scan or dataset; empty if nobody knows where it is.
  std::filesystem::path archive = {};
};

/// Counts what the first page of a report shows.
struct ReportJobResult {
  std::int64_t scans = 0;
  std::int64_t failures = 0;
};

/// The data of a job that makes the first page of a report.
struct ReportJobData {
  bool index_only = false;  ///< There are no pages of single scans.
};

/// The kind whose jobs make the page of one scan from its dataset. Their data is a PageJobData.
const JobKind& page_kind();
/// The kind whose jobs make the page of one recognised scene. Their data is a SceneJobData.
const JobKind& scene_kind();
/// The kind whose job makes the first page of a report. Its data is a ReportJobData, its
/// result a ReportJobResult.
const JobKind& report_kind();

/// Returns what the first page shows that is there. Reads that page alone. Counts nothing if it is
/// not there or of another version.
ReportJobResult shown_on_first_page(const std::filesystem::path& page);

/// Returns the job that makes the page of a scan. `dataset_key` is the key of the job that made its
/// dataset, or will. `folder` is that of the report.
Job page_job(const std::string& name, const std::filesystem::path& dataset,
             const std::string& dataset_key, const std::filesystem::path& folder);

/// Returns the job that makes the page of a recognised scene. It has a key if the recognised file
/// can be read.
Job scene_job(const std::string& name, const std::filesystem::path& scene,
              const std::filesystem::path& archive, const std::filesystem::path& folder);

/// Returns the job that makes the first page, without its key.
Job report_job(const std::filesystem::path& archive, const std::filesystem::path& folder,
               bool index_only);

}  // namespace semigeo::jobs
