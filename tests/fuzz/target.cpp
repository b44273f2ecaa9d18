#include "tests/fuzz/target.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "tests/support/temporary_folder.hpp"

namespace semigeo::fuzz {
namespace {

/// The most CPU time that an input may take. Sanitizers make the code several times as slow.
constexpr double kMostSeconds = 1;

double cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Returns the limit of CPU time. A variable of the environment raises it where the measurement
/// itself takes time, as that of coverage does.
double most_seconds() {
  const char* const factor = std::getenv("SEMIGEO_FUZZ_SLOWNESS");
  return kMostSeconds * (factor == nullptr ? 1 : std::atof(factor));
}

}  // namespace

void check(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "finding: %s\n", what);
  std::abort();
}

const std::filesystem::path& folder() {
  // A file system in memory, because each input becomes a file.
  setenv("TMPDIR", "/dev/shm", /*overwrite=*/0);
  static const tests::TemporaryFolder folder;
  return folder.path();
}

std::filesystem::path write(const std::string& name, std::string_view bytes) {
  std::filesystem::path path = folder() / name;
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const bool written =
      file >= 0 && ::write(file, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
  if (!written || close(file) != 0) {
    std::perror(path.c_str());
    std::exit(1);
  }
  return path;
}

}  // namespace semigeo::fuzz

/// Is called by libFuzzer for each input.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const double most = semigeo::fuzz::most_seconds();
  const double begin = semigeo::fuzz::cpu_seconds();
  semigeo::fuzz::read_input({reinterpret_cast<const char*>(data), size});
  semigeo::fuzz::check(semigeo::fuzz::cpu_seconds() - begin <= most,
                       "the input takes more than a second of CPU time");
  return 0;
}
