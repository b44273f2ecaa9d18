#include "engine/spawn.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cmath>
#include <cstdlib>
#include <system_error>
#include <utility>

namespace semigeo::engine {
namespace {

constexpr int kFirstUnused = kAnswersDescriptor + 1;

[[noreturn]] void fail(const Program& program, int error) {
  throw std::system_error(error, std::generic_category(),
                          "cannot start " + program.arguments.front());
}

/// Returns the limit with the wanted value, or with its hard limit if that is lower.
rlimit lowered(rlimit limit, rlim_t wish) {
  limit.rlim_cur = std::min(wish, limit.rlim_max);
  return limit;
}

/// Returns seconds for RLIMIT_CPU, which counts whole ones.
rlim_t whole_seconds(double seconds) {
  return seconds > 0 && seconds < 1e15 ? static_cast<rlim_t>(std::ceil(seconds)) : RLIM_INFINITY;
}

/// Does all that happens between vfork and exec. It is prepared before, because the child uses the
/// memory of this process, in which other threads go on, and may only make async-signal-safe calls.
class Launch {
 public:
  explicit Launch(const Program& program) {
    for (const std::string& argument : program.arguments)
      arguments_.push_back(const_cast<char*>(argument.c_str()));
    arguments_.push_back(nullptr);
    for (char** variable = environ; *variable != nullptr; ++variable)
      environment_.push_back(*variable);
    for (const std::string& variable : program.environment)
      if (getenv(variable.substr(0, variable.find('=')).c_str()) == nullptr)
        environment_.push_back(const_cast<char*>(variable.c_str()));
    environment_.push_back(nullptr);
    // The copies get numbers above the descriptors that dup2 is going to replace.
    const int sources[] = {program.input, program.output, program.output, program.answers};
    for (int target = 0; target < kFirstUnused; ++target)
      if (sources[target] >= 0) sources_[target] = moved_up(program, sources[target]);
    Pipe pipe = make_pipe();
    if (!pipe.from) fail(program, errno);
    failure_ = std::move(pipe.from);
    report_ = moved_up(program, pipe.to.get());

    getrlimit(RLIMIT_AS, &address_space_);
    if (program.address_space_bytes > 0) {
      address_space_ = lowered(address_space_, program.address_space_bytes);
      address_space_.rlim_max = address_space_.rlim_cur;
    }
    // The hard limit is left alone, because only root could raise it again for the next job.
    getrlimit(RLIMIT_CPU, &cpu_time_);
    cpu_time_ = lowered(cpu_time_, whole_seconds(program.cpu_seconds));
  }

  /// Returns 0, or the errno that says why the program does not run. `process` may have to be
  /// waited for even then.
  int run(pid_t& process) {
    // No signal handler of this process may run in the child, which shares its memory.
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    process = vfork();
    if (process == 0) become_program();
    const int error = process < 0 ? errno : 0;
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    report_.close();
    return error != 0 ? error : reported_failure();
  }

 private:
  static Descriptor moved_up(const Program& program, int descriptor) {
    Descriptor moved(fcntl(descriptor, F_DUPFD_CLOEXEC, kFirstUnused));
    if (!moved) fail(program, errno);
    return moved;
  }

  /// Returns 0 or the errno of a failure. A successful exec closes the pipe, and nothing is sent.
  int reported_failure() const {
    int error = 0;
    while (read(failure_.get(), &error, sizeof error) < 0 && errno == EINTR) {
    }
    return error;
  }

  [[noreturn]] void become_program() {
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent_) _exit(EXIT_FAILURE);  // the parent ended before prctl
    for (int target = 0; target < kFirstUnused; ++target)
      if (sources_[target] && dup2(sources_[target].get(), target) < 0) give_up();
    const int first_unused = sources_[kAnswersDescriptor] ? kFirstUnused : kAnswersDescriptor;
    if (close_range(first_unused, UINT_MAX, CLOSE_RANGE_CLOEXEC) != 0) give_up();
    if (setrlimit(RLIMIT_CORE, &no_core_) != 0) give_up();
    if (setrlimit(RLIMIT_CPU, &cpu_time_) != 0) give_up();
    if (setrlimit(RLIMIT_AS, &address_space_) != 0) give_up();
    reset_signals();
    execve(arguments_.front(), arguments_.data(), environment_.data());
    give_up();
  }

  /// Resets all signals. exec resets handlers, but ignored and blocked signals would stay so.
  void reset_signals() const {
    struct sigaction action = {};
    action.sa_handler = SIG_DFL;
    for (int number = 1; number < NSIG; ++number) sigaction(number, &action, nullptr);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
  }

  [[noreturn]] void give_up() const {
    const int error = errno;
    if (write(report_.get(), &error, sizeof error) < 0) _exit(EXIT_FAILURE);
    _exit(EXIT_FAILURE);
  }

  const pid_t parent_ = getpid();
  const rlimit no_core_ = {0, 0};
  std::vector<char*> arguments_;
  std::vector<char*> environment_;
  Descriptor sources_[kFirstUnused];  ///< Element d becomes descriptor d.
  Descriptor failure_;                ///< The errno of a failure arrives here.
  Descriptor report_;                 ///< The errno is sent here.
  rlimit address_space_ = {};
  rlimit cpu_time_ = {};
};

}  // namespace

pid_t spawn(const Program& program) {
  Launch launch(program);
  pid_t process = -1;
  const int error = launch.run(process);
  if (error == 0) return process;
  while (process > 0 && waitpid(process, nullptr, 0) < 0 && errno == EINTR) {
  }
  fail(program, error);
}

Descriptor watch(pid_t process) {
  // The system call is made directly, because the header of pidfd_open in glibc 2.36 is not valid
  // C++.
  Descriptor descriptor(static_cast<int>(syscall(SYS_pidfd_open, process, 0)));
  if (!descriptor)
    throw std::system_error(errno, std::generic_category(), "cannot watch a process");
  return descriptor;
}

void limit_cpu_time(pid_t process, double seconds) {
  rlimit limit = {};
  if (prlimit(process, RLIMIT_CPU, nullptr, &limit) == 0) {
    limit = lowered(limit, whole_seconds(seconds));
    if (prlimit(process, RLIMIT_CPU, &limit, nullptr) == 0) return;
  }
  if (errno == ESRCH) return;  // the process has ended
  throw std::system_error(errno, std::generic_category(), "cannot limit the CPU time of a process");
}

}  // namespace semigeo::engine
