#pragma once

#include <filesystem>
#include <string>

namespace semigeo::fuzz {

// Each of these writes seeds to FOLDER/<target>/<name>.

void make_file_seeds(const std::filesystem::path& folder);
void make_job_seeds(const std::filesystem::path& folder);

/// Writes a seed of a target.
void put_seed(const std::filesystem::path& folder, const std::string& target,
              const std::string& name, const std::string& bytes);

}  // namespace semigeo::fuzz
