#include "jobs/archive/verification.hpp"

#include <csignal>
#include <cstdint>
#include <system_error>

#include "io/dataset/dataset.hpp"
#include "io/files/error.hpp"
#include "io/library/hash_library.hpp"
#include "jobs/archive/in_children.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

/// Returns the CPU seconds that verifying may take. It is a thousand times what it usually takes;
/// the limit is needed because HDF5 loops forever on some damaged files.
double most_seconds(const fs::path& file) {
  constexpr std::uintmax_t kLeast = 2;
  constexpr std::uintmax_t kBytesPerSecond = 10'000'000;
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(file, error);
  return static_cast<double>(kLeast + (error ? 0 : bytes / kBytesPerSecond));
}

/// Reads everything in a file. Throws if something is wrong with it.
using Verify = void (*)(const fs::path&);

std::string problem_of(const fs::path& file, Verify verify) {
  try {
    verify(file);
    return "";
  } catch (const std::exception& e) {
    return e.what();
  }
}

std::string result_of(const engine::ForkedResult& result, const fs::path& file) {
  if (result.exit_code == 0) return result.text;
  return io::Error(file, "",
                   result.signal == SIGXCPU ? "it is damaged so that HDF5 never ends reading it"
                                            : "it is damaged so that HDF5 crashes over it",
                   "remove it and run again, or run with --verify")
      .what();
}

std::vector<std::string> verify_all(const std::vector<fs::path>& files, Verify verify,
                                    int at_once) {
  const auto results = in_children(
      files.size(), at_once, [&](std::size_t i) { return problem_of(files[i], verify); },
      [&](std::size_t i) { return most_seconds(files[i]); });
  std::vector<std::string> problems;
  for (std::size_t i = 0; i < files.size(); ++i)
    problems.push_back(result_of(results[i], files[i]));
  return problems;
}

}  // namespace

std::vector<std::string> verify_datasets(const std::vector<fs::path>& datasets, int at_once) {
  return verify_all(
      datasets, [](const fs::path& file) { io::Dataset(file).verify(); }, at_once);
}

std::vector<std::string> verify_libraries(const std::vector<fs::path>& libraries) {
  return verify_all(
      libraries, [](const fs::path& file) { io::HashLibrary(file).verify(); }, 1);
}

}  // namespace semigeo::jobs
