#include "engine/fork_child.hpp"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "engine/lack_of_memory.hpp"
#include "engine/spawn.hpp"

namespace semigeo::engine {
namespace {

[[noreturn]] void fail(const char* action) {
  throw std::system_error(errno, std::generic_category(), action);
}

/// Does all the work of the child.
[[noreturn]] void work_and_exit(const std::function<std::string()>& work, double cpu_seconds,
                                pid_t parent, const Descriptor& answer) noexcept {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(EXIT_FAILURE);  // the parent ended before prctl
  // The messages of the C library about a crash are of no use to users.
  const Descriptor nowhere = open_file("/dev/null", O_WRONLY);
  if (nowhere) dup2(nowhere.get(), STDERR_FILENO);
  end_for_lack_of_memory("", kNoMemoryCode);
  errno = 0;
  const rlimit no_core = {0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  if (cpu_seconds > 0) limit_cpu_time(getpid(), cpu_seconds);
  const std::string text = work();
  _exit(write_all(answer, text) ? EXIT_SUCCESS : EXIT_FAILURE);
}

}  // namespace

ForkedChild::ForkedChild(const std::function<std::string()>& work, double cpu_seconds) {
  Pipe pipe = make_pipe();
  if (!pipe.from) fail("cannot make a pipe");
  const pid_t parent = getpid();
  process_ = fork();
  if (process_ == 0) work_and_exit(work, cpu_seconds, parent, pipe.to);
  if (process_ < 0) fail("cannot start a process");
  answer_ = std::move(pipe.from);
}

ForkedChild::ForkedChild(ForkedChild&& other) noexcept
    : process_(std::exchange(other.process_, -1)), answer_(std::move(other.answer_)) {}

ForkedChild::~ForkedChild() {
  if (process_ <= 0) return;
  ::kill(process_, SIGKILL);
  while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

ForkedResult ForkedChild::wait() {
  ForkedResult result;
  std::array<char, 4096> buffer;
  for (;;) {
    const ssize_t count = read(answer_.get(), buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("cannot read what a process has answered");
    if (count == 0) break;
    result.text.append(buffer.data(), static_cast<std::size_t>(count));
  }
  answer_.close();
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  return result;
}

}  // namespace semigeo::engine
