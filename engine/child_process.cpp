#include "engine/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "engine/spawn.hpp"

namespace semigeo::engine {
namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void fail(const std::string& action) {
  throw std::system_error(errno, std::generic_category(), action);
}

Clock::time_point seconds_from_now(double seconds) {
  constexpr double kNever = 1e9;
  if (!(seconds < kNever)) return Clock::time_point::max();
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(
                            std::chrono::duration<double>(std::max(seconds, 0.0)));
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

Descriptor open_log(const Command& command) {
  if (command.log.empty()) return open_file("/dev/null", O_WRONLY);
  if (command.log.has_parent_path()) std::filesystem::create_directories(command.log.parent_path());
  // Text is appended even to an empty file, so that writers do not overwrite each other.
  const int flags = O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW;
  Descriptor log = open_file(command.log, command.append_to_log ? flags : flags | O_TRUNC);
  if (!log) fail("cannot open " + command.log.string());
  return log;
}

/// Returns the CPU time that the limit on it counts, which is in ticks of the clock. On a busy
/// machine it differs from the exact time of clock_getcpuclockid by any factor.
double cpu_seconds_of(pid_t process) {
  // The kernel composes the number of this clock of the process and of CPUCLOCK_PROF, which is 0.
  const auto clock = static_cast<clockid_t>(~static_cast<unsigned>(process) << 3);
  timespec time = {};
  if (clock_gettime(clock, &time) != 0) return 0;
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

struct ChildProcesses::Child {
  Child() = default;
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    signal_group(SIGKILL);
    while (process > 0 && waitpid(process, nullptr, 0) < 0 && errno == EINTR) {
    }
  }

  Id id = 0;
  pid_t process = -1;  ///< No other process gets this number before it is waited for.
  Descriptor end;      ///< A pidfd, which is readable when the process has ended.
  Descriptor channel;  ///< Carries lines in both directions.
  std::string to_send;
  bool close_input = false;  ///< The input is closed when `to_send` is sent.
  std::string received;      ///< The beginning of a line.
  Clock::time_point start;
  Clock::time_point deadline = Clock::time_point::max();
  Limit exceeded = Limit::kNone;

  void signal_group(int number) const {
    if (process > 0) ::kill(-process, number);
  }
  void kill_for(Limit limit) {
    if (exceeded == Limit::kNone) exceeded = limit;
    deadline = Clock::time_point::max();
    signal_group(SIGKILL);
  }
};

ChildProcesses::ChildProcesses() : wake_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (!wake_) fail("cannot make an eventfd");
  // Some parents leave SIGCHLD ignored. Then no child could be waited for.
  struct sigaction action = {};
  if (sigaction(SIGCHLD, nullptr, &action) == 0 && action.sa_handler == SIG_IGN)
    signal(SIGCHLD, SIG_DFL);
}

ChildProcesses::~ChildProcesses() {
  // All children are killed before the first one is waited for.
  for (const auto& [id, child] : children_) child->signal_group(SIGKILL);
}

ChildProcesses::Id ChildProcesses::start(const Command& command) {
  if (command.arguments.empty()) throw std::invalid_argument("a command without a program");
  auto child = std::make_unique<Child>();
  const Descriptor output = open_log(command);
  Descriptor input;
  if (command.converses) {
    // A socket is used instead of two pipes, because writing to a child that has ended is then an
    // error and no SIGPIPE.
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) fail("cannot make a socket");
    child->channel = Descriptor(ends[0]);
    input = Descriptor(ends[1]);
  } else {
    input = open_file("/dev/null", O_RDONLY);
  }
  if (!input || !output) fail("cannot open /dev/null");

  child->id = next_id_++;
  child->start = Clock::now();
  child->process = spawn({.arguments = command.arguments,
                          .input = input.get(),
                          .output = output.get(),
                          .answers = command.converses ? input.get() : -1,
                          .address_space_bytes = command.limits.address_space_bytes,
                          .cpu_seconds = command.limits.cpu_seconds,
                          .environment = command.environment});
  child->end = watch(child->process);
  if (command.limits.wall_seconds > 0)
    child->deadline = seconds_from_now(command.limits.wall_seconds);
  const Id id = child->id;
  children_.emplace(id, std::move(child));
  return id;
}

ChildProcesses::Child* ChildProcesses::find(Id id) const {
  const auto found = children_.find(id);
  return found == children_.end() ? nullptr : found->second.get();
}

void ChildProcesses::send(Id id, std::string_view line) {
  if (line.find('\n') != std::string_view::npos)
    throw std::invalid_argument("a line with a newline in it");
  Child* child = find(id);
  if (child == nullptr || !child->channel || child->close_input) return;
  child->to_send.append(line).append("\n");
  flush(*child);
}

void ChildProcesses::close_input(Id id) {
  Child* child = find(id);
  if (child == nullptr || !child->channel) return;
  child->close_input = true;
  flush(*child);
}

void ChildProcesses::flush(Child& child) {
  while (!child.to_send.empty()) {
    const ssize_t sent = ::send(child.channel.get(), child.to_send.data(), child.to_send.size(),
                                MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent >= 0) {
      child.to_send.erase(0, sent);
    } else if (errno == EAGAIN || errno == ENOBUFS) {
      return;
    } else if (errno != EINTR) {
      child.to_send.clear();  // nobody reads it any more
    }
  }
  if (child.close_input) shutdown(child.channel.get(), SHUT_WR);
}

void ChildProcesses::restart_clocks(Id id, double cpu_seconds, double wall_seconds) {
  Child* child = find(id);
  if (child == nullptr || child->exceeded != Limit::kNone) return;
  limit_cpu_time(child->process,
                 cpu_seconds > 0 ? cpu_seconds_of(child->process) + cpu_seconds : 0);
  child->deadline = wall_seconds > 0 ? seconds_from_now(wall_seconds) : Clock::time_point::max();
}

void ChildProcesses::terminate(Id id) {
  if (const Child* child = find(id)) child->signal_group(SIGTERM);
}

void ChildProcesses::kill(Id id) {
  if (Child* child = find(id)) child->kill_for(Limit::kNone);
}

/// Reads from a child, once at most, so that the other children get their turn.
void ChildProcesses::receive(Child& child) {
  std::array<char, 65536> buffer;
  const ssize_t got = recv(child.channel.get(), buffer.data(), buffer.size(), MSG_DONTWAIT);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (got <= 0) {  // closed, or reset because the child ended with unread lines
    child.channel.close();
    return;
  }
  std::string_view rest(buffer.data(), got);
  for (std::size_t newline; (newline = rest.find('\n')) != std::string_view::npos;) {
    child.received.append(rest.substr(0, newline));
    events_.push_back(Line{child.id, std::exchange(child.received, {})});
    rest.remove_prefix(newline + 1);
  }
  child.received.append(rest);
  if (child.received.size() > kLongestLine) {
    child.kill_for(Limit::kLineLength);  // it comes first, or the child could end by SIGPIPE
    child.channel.close();
  }
}

/// Ends a child whose process has ended but was not waited for yet.
void ChildProcesses::end(Child& child) {
  child.signal_group(SIGKILL);  // ends what the child has left running
  // Lines that it sent before are read. Their number is limited, because a process that has left
  // the group could send for ever.
  for (std::size_t reads = 0; child.channel && reads < 64; ++reads) {
    pollfd more = {child.channel.get(), POLLIN, 0};
    if (poll(&more, 1, 0) <= 0) break;
    receive(child);
  }
  int status = 0;
  rusage usage = {};
  while (wait4(child.process, &status, 0, &usage) < 0)
    if (errno != EINTR) fail("cannot wait for a process");
  child.process = -1;
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  Limit limit = Limit::kNone;
  if (signal == SIGXCPU) limit = Limit::kCpuTime;
  if (signal == SIGKILL) limit = child.exceeded;
  events_.push_back(Ended{.child = child.id,
                          .exit_code = signal == 0 ? WEXITSTATUS(status) : -1,
                          .signal = signal,
                          .limit = limit,
                          .wall_seconds = seconds_since(child.start),
                          .cpu_seconds = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime),
                          .peak_resident_bytes = std::uint64_t{1024} * usage.ru_maxrss});
  children_.erase(children_.find(child.id));
}

void ChildProcesses::enforce_deadlines() {
  const Clock::time_point now = Clock::now();
  for (const auto& [id, child] : children_)
    if (child->deadline <= now) child->kill_for(Limit::kWallTime);
}

/// Turns what has happened into events. If nothing has, it waits until `until` or the next
/// deadline.
void ChildProcesses::collect(Clock::time_point until) {
  std::vector<pollfd> watched = {{wake_.get(), POLLIN, 0}};
  std::vector<Child*> children;
  for (const auto& [id, child] : children_) {
    until = std::min(until, child->deadline);
    const short sending = child->to_send.empty() ? 0 : POLLOUT;
    watched.push_back({child->channel.get(), static_cast<short>(POLLIN | sending), 0});
    watched.push_back({child->end.get(), POLLIN, 0});
    children.push_back(child.get());
  }
  const auto left = std::max(until - Clock::now(), Clock::duration::zero());
  const auto seconds = std::chrono::floor<std::chrono::seconds>(left);
  const timespec timeout = {seconds.count(), (left - seconds).count()};
  if (ppoll(watched.data(), watched.size(), &timeout, nullptr) < 0) {
    if (errno == EINTR) return;
    fail("cannot wait for processes");
  }

  if (watched[0].revents != 0) {
    std::uint64_t times;
    if (read(wake_.get(), &times, sizeof times) > 0) events_.push_back(Woken{});
  }
  for (std::size_t c = 0; c < children.size(); ++c) {
    Child& child = *children[c];
    const auto channel = watched[1 + 2 * c].revents;
    if (channel & POLLOUT) flush(child);
    if (channel & ~POLLOUT) receive(child);
    if (watched[2 + 2 * c].revents != 0) end(child);
  }
}

ChildProcesses::Event ChildProcesses::wait(double seconds) {
  const Clock::time_point until = seconds_from_now(seconds);
  for (bool last = false; events_.empty() && !last;) {
    last = Clock::now() >= until;
    enforce_deadlines();
    collect(until);
  }
  if (events_.empty()) return TimedOut{};
  Event event = std::move(events_.front());
  events_.pop_front();
  return event;
}

void ChildProcesses::wake() noexcept {
  const int error = errno;
  const std::uint64_t once = 1;
  // The call fails only if the counter is full, and then `wait` wakes anyway.
  [[maybe_unused]] const ssize_t written = write(wake_.get(), &once, sizeof once);
  errno = error;
}

}  // namespace semigeo::engine
