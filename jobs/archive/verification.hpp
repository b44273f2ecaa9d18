#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace semigeo::jobs {

/// Reads everything in each dataset (io::Dataset::verify); what is wrong with it as one sentence,
/// or nothing. Each is read in a child process, `at_once` of them at a time (0: one per core): HDF5
/// crashes over some damages, and two processes do not share its lock. Threads that use HDF5
/// meanwhile would leave that lock closed for the children: there must be none.
std::vector<std::string> verify_datasets(const std::vector<std::filesystem::path>& datasets,
                                         int at_once);
/// The same of libraries (io::HashLibrary::verify), one after the other.
std::vector<std::string> verify_libraries(const std::vector<std::filesystem::path>& libraries);

}  // namespace semigeo::jobs
