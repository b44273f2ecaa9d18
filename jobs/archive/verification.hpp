#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace semigeo::jobs {

/// What reading a whole file has shown.
struct Verified {
  std::string problem = {};  ///< One sentence; empty if every byte is as it was written.
  /// If false, the system refused to read the file or had no memory: the file may be whole.
  bool was_read = true;
};

/// Reads everything in each dataset (io::Dataset::verify). Returns what is wrong with each. Each is
/// read in a child process (engine::ForkedChild), `at_once` of them at a time (0: one for each
/// core), because HDF5 crashes on some damaged files, and two processes do not share its lock. No
/// thread may use HDF5 meanwhile: the lock would stay closed in the children.
std::vector<Verified> verify_datasets(const std::vector<std::filesystem::path>& datasets,
                                      int at_once);
/// Reads everything in each library (io::HashLibrary::verify) in the same way, one library after
/// the other.
std::vector<Verified> verify_libraries(const std::vector<std::filesystem::path>& libraries);

}  // namespace semigeo::jobs
