#include "engine/run_command.hpp"

#include <poll.h>
#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <climits>
#include <system_error>

#include "engine/spawn.hpp"

namespace semigeo::engine {
namespace {

using Clock = std::chrono::steady_clock;
using Bound = CommandResult::Bound;

[[noreturn]] void fail(const std::vector<std::string>& arguments) {
  throw std::system_error(errno, std::generic_category(), "cannot start " + arguments.front());
}

/// Returns whether the descriptor can be read before `until`.
bool is_readable(const Descriptor& descriptor, Clock::time_point until) {
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
    if (left <= 0) return false;
    pollfd waiting = {descriptor.get(), POLLIN, 0};
    const int ready = poll(&waiting, 1, static_cast<int>(std::min<long>(left, INT_MAX)));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
  }
}

/// Reads until the other end is closed. Returns the bound that stopped it.
Bound read_all(const Descriptor& from, Clock::time_point until, std::size_t most,
               std::string& text) {
  std::array<char, 65536> bytes;
  for (;;) {
    if (!is_readable(from, until)) return Bound::kSeconds;
    const ssize_t count = read(from.get(), bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return Bound::kNone;
    const std::size_t room = most - text.size();
    text.append(bytes.data(), std::min<std::size_t>(room, static_cast<std::size_t>(count)));
    if (static_cast<std::size_t>(count) > room) return Bound::kBytes;
  }
}

}  // namespace

CommandResult run_command(const std::vector<std::string>& arguments, const CommandBounds& bounds) {
  const auto until = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                        std::chrono::duration<double>(bounds.seconds));
  const Descriptor nothing = open_file("/dev/null", O_RDONLY);
  Pipe pipe = make_pipe();
  if (!nothing || !pipe.from) fail(arguments);
  const pid_t process = spawn({.arguments = arguments,
                               .input = nothing.get(),
                               .output = pipe.to.get(),
                               .answers = -1,
                               .address_space_bytes = 0,
                               .cpu_seconds = 0});
  pipe.to.close();
  CommandResult result;
  result.exceeded = read_all(pipe.from, until, bounds.bytes, result.text);
  // The program may have closed its output and still run.
  if (result.exceeded == Bound::kNone && !is_readable(watch(process), until))
    result.exceeded = Bound::kSeconds;
  if (result.exceeded != Bound::kNone) ::kill(-process, SIGKILL);
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

}  // namespace semigeo::engine
