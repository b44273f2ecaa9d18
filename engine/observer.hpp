#pragma once

#include <cstdint>
#include <string_view>

namespace semigeo::engine {

/// Receives the events of the engine, which itself never prints. Calls come from any thread.
class Observer {
 public:
  virtual ~Observer() = default;
  /// Is called when `amount` units of work (vertices times levels) are done.
  virtual void worked(std::int64_t amount) { (void)amount; }
  /// Is called when a part of a computation has ended. `stretch` is its name, `seconds` the time
  /// on the clock, and `cpu_seconds` the CPU time of all threads of the process together.
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
