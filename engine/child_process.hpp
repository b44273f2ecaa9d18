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

/// What a child process may take; 0 = no limit of ours.
struct ProcessLimits {
  /// Allocations beyond it fail in the child, which has to end by itself.
  std::uint64_t address_space_bytes = 0;
  double cpu_seconds = 0;   ///< of all its threads together, rounded up to whole seconds
  double wall_seconds = 0;  ///< kept while the owner is inside `wait`
};

struct Command {
  std::vector<std::string> arguments;  ///< [0] is the path of the program; PATH is not searched
  ProcessLimits limits = {};
  /// Takes standard output and standard error; made, with its folder. Empty: they are dropped.
  std::filesystem::path log = {};
  bool append_to_log = false;  ///< else the log starts empty
  /// The child gets lines on descriptor 0 and answers with lines on descriptor 3
  /// (kAnswersDescriptor). Otherwise its standard input is empty.
  bool converses = false;
};

/// Child processes with limits, and everything that comes from them in one queue. Used by one
/// thread, which must live as long as the children: they are killed when it ends, even by SIGKILL.
///
/// A child and what it starts are one process group. The group is killed with its child, and no
/// child outlives this object. An id is never used twice; on a child that has ended, every function
/// that takes an id does nothing.
///
/// Every function throws std::system_error where the system lets it down. Needs Linux 5.11.
class ChildProcesses {
 public:
  using Id = std::int64_t;
  enum class Limit { kNone, kWallTime, kCpuTime, kLineLength };
  static constexpr double kForever = std::numeric_limits<double>::infinity();
  /// A child that sends a longer line is killed: a broken one must not fill our memory.
  static constexpr std::size_t kLongestLine = std::size_t{1} << 20;

  struct TimedOut {};
  struct Woken {};
  struct Line {
    Id child;
    std::string text;  ///< without the newline
  };
  /// Comes after the child's last line. What it sent after its last newline is dropped.
  struct Ended {
    Id child;
    int exit_code;  ///< -1 if it ended by a signal
    int signal;     ///< 0 if it ended by itself
    Limit limit;    ///< the limit that ended it; one on address space shows in the exit code only
    double wall_seconds;
    double cpu_seconds;
    /// At least what this process had resident when it started the child, which Linux counts too.
    std::uint64_t peak_resident_bytes;
  };
  using Event = std::variant<TimedOut, Woken, Line, Ended>;

  /// Where SIGCHLD is ignored, it becomes default: the kernel would keep no exit code for us.
  ChildProcesses();
  /// Kills the children that are left, and waits for them.
  ~ChildProcesses();
  ChildProcesses(const ChildProcesses&) = delete;
  ChildProcesses& operator=(const ChildProcesses&) = delete;

  /// Throws std::system_error, too, when the program is missing or cannot be executed.
  Id start(const Command& command);
  std::size_t running() const { return children_.size(); }

  /// The line must hold no newline. Never waits: what the child does not read yet is kept here and
  /// sent during `wait`.
  void send(Id child, std::string_view line);
  /// The child finds its input ended after what has been sent.
  void close_input(Id child);

  /// New limits on time, counted from now, instead of those before: for a child that does one job
  /// after the other. 0 = none, for one that waits for its next job.
  void restart_clocks(Id child, double cpu_seconds, double wall_seconds);

  /// SIGTERM and SIGKILL, to the child's process group.
  void terminate(Id child);
  void kill(Id child);

  /// The next event, in the order of arrival; TimedOut when there is none for so many seconds.
  Event wait(double seconds = kForever);
  /// Makes `wait` return Woken, the current call or the next. Several calls may give one Woken. For
  /// signal handlers and other threads.
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
