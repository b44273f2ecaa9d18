#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/descriptor.hpp"

namespace semigeo::engine {

/// Holds the limits of a child process. A limit of 0 is not set.
struct ProcessLimits {
  /// Allocations beyond this number of bytes fail in the child, which has to end by itself.
  std::uint64_t address_space_bytes = 0;
  double cpu_seconds = 0;   ///< CPU time of all its threads together, rounded up to whole seconds.
  double wall_seconds = 0;  ///< Time on the clock. It is enforced while the owner is inside `wait`.
};

/// Describes what a child process runs, and under which limits.
struct Command {
  std::vector<std::string> arguments;  ///< [0] is the path of the program. PATH is not searched.
  ProcessLimits limits = {};
  /// Variables "NAME=value" for a program whose environment does not have them yet.
  std::vector<std::string> environment = {};
  /// This file takes standard output and standard error. It is created together with its folder. If
  /// the path is empty, both are dropped. A symbolic link at the path is not followed.
  std::filesystem::path log = {};
  bool append_to_log = false;  ///< If false, the log starts empty.
  /// If true, the child gets lines on descriptor 0 and answers with lines on descriptor 3
  /// (kAnswersDescriptor). If false, its standard input is empty.
  bool converses = false;
};

/// Runs child processes with limits and puts everything that comes from them into one queue. It is
/// used by one thread, which must live as long as the children: they are killed when it ends, even
/// by SIGKILL.
///
/// A child and what it starts are one process group. The group is killed with its child, and no
/// child outlives this object. An id is never used twice. On a child that has ended, every function
/// that takes an id does nothing.
///
/// Every function throws std::system_error if a system call fails. Needs Linux 5.11.
class ChildProcesses {
 public:
  /// Names a child.
  using Id = std::int64_t;
  /// The limit that ended a child.
  enum class Limit { kNone, kWallTime, kCpuTime, kLineLength };
  /// The number of seconds for which `wait` waits as long as it takes.
  static constexpr double kForever = std::numeric_limits<double>::infinity();
  /// A child that sends a longer line is killed: a broken one must not fill our memory. In bytes.
  static constexpr std::size_t kLongestLine = std::size_t{1} << 20;

  /// Nothing happened within the time that `wait` was given.
  struct TimedOut {};
  /// Somebody called `wake`.
  struct Woken {};
  /// A child has sent a line.
  struct Line {
    Id child;
    std::string text;  ///< The line without its newline.
  };
  /// A child has ended. This event comes after the child's last line. Text after the last newline
  /// is dropped.
  struct Ended {
    Id child;
    int exit_code;  ///< -1 if a signal ended the child.
    int signal;     ///< 0 if the child ended by itself.
    Limit limit;    ///< The limit that ended it. A limit on memory shows in the exit code only.
    double wall_seconds;
    double cpu_seconds;
    /// Never less than what this process had resident when it started the child, which Linux counts
    /// too.
    std::uint64_t peak_resident_bytes;
  };
  /// What `wait` reports.
  using Event = std::variant<TimedOut, Woken, Line, Ended>;

  /// Makes SIGCHLD default where it is ignored, because the kernel would keep no exit code for us.
  ChildProcesses();
  /// Kills the children that are left and waits for them.
  ~ChildProcesses();
  ChildProcesses(const ChildProcesses&) = delete;
  ChildProcesses& operator=(const ChildProcesses&) = delete;

  /// Starts a child. Throws std::system_error also if the program is missing or cannot be executed.
  Id start(const Command& command);
  std::size_t running() const { return children_.size(); }

  /// Sends a line, which must hold no newline. Never waits: what the child does not read yet is
  /// kept here and sent during `wait`.
  void send(Id child, std::string_view line);
  /// Ends the input of the child after what has been sent.
  void close_input(Id child);

  /// Replaces the limits on time by new ones, counted from now: for a child that does one job after
  /// another. 0 means no limit, for a child that waits for its next job.
  void restart_clocks(Id child, double cpu_seconds, double wall_seconds);

  /// Sends SIGTERM to the child's process group.
  void terminate(Id child);
  /// Sends SIGKILL to the child's process group.
  void kill(Id child);

  /// Returns the next event in the order of arrival, or TimedOut if there is none within this
  /// number of seconds.
  Event wait(double seconds = kForever);
  /// Makes `wait` return Woken, in the current call or in the next. Several calls may give one
  /// Woken. May be called by signal handlers and by other threads.
  void wake() noexcept;

 private:
  using Clock = std::chrono::steady_clock;
  struct Child;

  Child* find(Id id) const;
  void receive(Child& child);
  void flush(Child& child);
  void end(Child& child);
  void enforce_deadlines();
  void collect(Clock::time_point until);

  Descriptor wake_;
  std::map<Id, std::unique_ptr<Child>> children_;
  std::deque<Event> events_;
  Id next_id_ = 1;
};

}  // namespace semigeo::engine
