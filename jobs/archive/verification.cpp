#include "jobs/archive/verification.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <system_error>
#include <thread>

#include "io/dataset/dataset.hpp"
#include "io/files/error.hpp"
#include "io/library/hash_library.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

/// CPU seconds that verifying may take: a thousand times what it takes, for HDF5 goes round in
/// circles over some damaged files.
rlim_t most_seconds(const fs::path& dataset) {
  constexpr std::uintmax_t kLeast = 2;
  constexpr std::uintmax_t kBytesPerSecond = 10'000'000;
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(dataset, error);
  return kLeast + (error ? 0 : bytes / kBytesPerSecond);
}

/// A process that verifies one file, and the end of the pipe that tells what it found.
struct Child {
  pid_t process = -1;
  int findings = -1;
};

/// Reads everything in a file; throws on what is wrong with it.
using Verify = void (*)(const fs::path&);

std::string problem_of(const fs::path& file, Verify verify) {
  try {
    verify(file);
    return "";
  } catch (const std::exception& e) {
    return e.what();
  }
}

[[noreturn]] void verify_and_exit(const fs::path& file, Verify verify, int findings) {
  // What the C library says of a crash is no sentence.
  const int nowhere = open("/dev/null", O_WRONLY);
  if (nowhere >= 0) dup2(nowhere, STDERR_FILENO);
  const rlimit limit = {most_seconds(file), RLIM_INFINITY};
  setrlimit(RLIMIT_CPU, &limit);
  const std::string problem = problem_of(file, verify);
  for (std::size_t at = 0; at < problem.size();) {
    const ssize_t written = write(findings, problem.data() + at, problem.size() - at);
    if (written < 0 && errno != EINTR) _exit(2);
    at += std::max<ssize_t>(written, 0);
  }
  _exit(0);
}

[[noreturn]] void fail(const char* action) {
  throw std::system_error(errno, std::generic_category(), action);
}

Child start(const fs::path& file, Verify verify) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) fail("cannot make a pipe");
  const pid_t process = fork();
  if (process == 0) verify_and_exit(file, verify, ends[1]);
  close(ends[1]);
  if (process < 0) {
    close(ends[0]);
    fail("cannot start a process");
  }
  return {process, ends[0]};
}

std::string result_of(const Child& child, const fs::path& dataset) {
  std::string problem;
  std::array<char, 4096> buffer;
  for (;;) {
    const ssize_t count = read(child.findings, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    problem.append(buffer.data(), static_cast<std::size_t>(count));
  }
  close(child.findings);
  int status = 0;
  while (waitpid(child.process, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return problem;
  const bool endless = WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU;
  return io::Error(dataset, "",
                   endless ? "it is damaged so that HDF5 never ends reading it"
                           : "it is damaged so that HDF5 crashes over it",
                   "remove it and run again, or run with --verify")
      .what();
}

std::vector<std::string> verify_all(const std::vector<fs::path>& files, Verify verify,
                                    std::size_t at_once) {
  std::vector<Child> children;
  std::vector<std::string> problems;
  for (std::size_t i = 0; i < files.size(); ++i) {
    while (children.size() < std::min(i + at_once, files.size()))
      children.push_back(start(files[children.size()], verify));
    problems.push_back(result_of(children[i], files[i]));
  }
  return problems;
}

}  // namespace

std::vector<std::string> verify_datasets(const std::vector<fs::path>& datasets, int at_once) {
  const auto cores = static_cast<int>(std::thread::hardware_concurrency());
  const auto most = static_cast<std::size_t>(std::max(at_once > 0 ? at_once : cores, 1));
  return verify_all(
      datasets, [](const fs::path& file) { io::Dataset(file).verify(); }, most);
}

std::vector<std::string> verify_libraries(const std::vector<fs::path>& libraries) {
  return verify_all(
      libraries, [](const fs::path& file) { io::HashLibrary(file).verify(); }, 1);
}

}  // namespace semigeo::jobs
