#pragma once

#include <cstdint>
#include <string_view>

namespace semigeo::engine {

/// Is told what the engine does; the engine itself never prints. Calls come from any thread.
class Observer {
 public:
  virtual ~Observer() = default;
  /// Is called when `amount` units of work (vertices times levels) are done.
  virtual void worked(std::int64_t amount) { (void)amount; }
  /// Is called when a part of a computation has ended. `stretch` is its name, `seconds` is the time
  /// on the clock, `cpu_seconds` that of all the process's threads together.
  virtual void timed(std::string_view stretch, double seconds, double cpu_seconds) {
    (void)stretch;
    (void)seconds;
    (void)cpu_seconds;
  }
  /// Is called when a task of a graph has ended. `error` is empty if it succeeded.
  virtual void task_ended(std::string_view task, std::string_view error) {
    (void)task;
    (void)error;
  }
};

}  // namespace semigeo::engine
