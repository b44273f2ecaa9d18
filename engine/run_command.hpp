#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace semigeo::engine {

/// Holds the limits at which a command is killed.
struct CommandBounds {
  double seconds = 60;                       ///< Time on the clock.
  std::size_t bytes = std::size_t{1} << 26;  ///< Number of bytes of output.
};

/// Tells how a command ended, and what it printed.
struct CommandResult {
  /// The bound that a command exceeded.
  enum class Bound { kNone, kSeconds, kBytes };
  std::string text;               ///< Standard output and standard error as they came.
  int exit_code = 0;              ///< -1 if a signal ended it.
  Bound exceeded = Bound::kNone;  ///< The bound for which it was killed.
};

/// Runs a program to its end and returns what it printed. `arguments[0]` is the path of the
/// program; PATH is not searched. Its standard input is empty. It returns when the program has
/// ended and no process holds its output any more. A program that takes longer or prints more is
/// killed with its process group. The result says so, and keeps the text up to there. Throws
/// std::system_error if the program cannot be started. The function is thread-safe.
CommandResult run_command(const std::vector<std::string>& arguments, const CommandBounds& bounds);

}  // namespace semigeo::engine
