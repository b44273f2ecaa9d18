#pragma once

#include <filesystem>

#include "jobs/plan/job.hpp"

namespace semigeo::jobs {

/// Returns the file in the folder of logs that takes what the job prints.
std::filesystem::path log_path(const std::filesystem::path& logs, const Job& job);

/// Removes logs that are empty because jobs were killed after opening them. Nobody must be writing
/// into the folder.
void remove_empty_logs(const std::filesystem::path& folder);

}  // namespace semigeo::jobs
