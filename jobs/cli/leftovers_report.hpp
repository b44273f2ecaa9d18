#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "jobs/kinds/leftovers.hpp"
#include "jobs/plan/job_kind.hpp"

namespace semigeo::jobs::cli {

/// Returns "2 datasets and 1 recognised file of scans that are gone (12 MB)".
std::string counts_in_words(const std::vector<Leftover>& leftovers);

/// Returns the leftovers as JSON: kind, name, scan, files and bytes of each.
nlohmann::json leftovers_json(const std::vector<Leftover>& leftovers);

/// Returns the sentence that says why nothing is removed without --force, or an empty text.
std::string reason_to_ask(const Leftovers& leftovers);

/// Returns the sentence about scans of which it is not known whether they are gone, or an empty
/// text.
std::string reason_to_look_again(const Leftovers& leftovers);

/// Returns the command that removes the leftovers of scans in the folders.
std::string prune_command(const std::filesystem::path& archive,
                          const std::vector<std::filesystem::path>& folders);

}  // namespace semigeo::jobs::cli
