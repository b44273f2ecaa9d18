#include "jobs/archive/verification.hpp"

#include <cerrno>
#include <cstdint>
#include <new>
#include <system_error>

#include "io/dataset/dataset.hpp"
#include "io/files/error.hpp"
#include "io/files/read_error.hpp"
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

constexpr char kRead = 'r';
constexpr char kRefused = 'x';

/// Returns a letter, which says whether the file could be read, and what is wrong with it.
std::string answer_about(const fs::path& file, Verify verify) {
  try {
    verify(file);
    return {kRead};
  } catch (const io::ReadError& e) {
    return std::string(1, e.is_absent() ? kRead : kRefused) + e.what();
  } catch (const std::bad_alloc&) {
    return kRefused + std::string(io::ReadError(ENOMEM, file, "", "needs too much memory").what());
  } catch (const std::exception& e) {
    return kRead + std::string(e.what());
  }
}

Verified result_of(const engine::ForkedResult& result, const fs::path& file) {
  if (result.exit_code == 0 && !result.text.empty())
    return {.problem = result.text.substr(1), .was_read = result.text.front() == kRead};
  return {.problem = unfinished_reading(result, file).what(), .was_read = tells_of_damage(result)};
}

std::vector<Verified> verify_all(const std::vector<fs::path>& files, Verify verify, int at_once) {
  const auto results = in_children(
      files.size(), at_once, [&](std::size_t i) { return answer_about(files[i], verify); },
      [&](std::size_t i) { return most_seconds(files[i]); });
  std::vector<Verified> verified;
  for (std::size_t i = 0; i < files.size(); ++i)
    verified.push_back(result_of(results[i], files[i]));
  return verified;
}

}  // namespace

std::vector<Verified> verify_datasets(const std::vector<fs::path>& datasets, int at_once) {
  return verify_all(
      datasets, [](const fs::path& file) { io::Dataset(file).verify(); }, at_once);
}

std::vector<Verified> verify_libraries(const std::vector<fs::path>& libraries) {
  return verify_all(
      libraries, [](const fs::path& file) { io::HashLibrary(file).verify(); }, 1);
}

}  // namespace semigeo::jobs
