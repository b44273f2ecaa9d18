#pragma once

#include <cstdint>
#include <string_view>

namespace semigeo::engine {

/// Told what the engine does; the engine itself never prints. Calls come from any thread.
class Observer {
 public:
  virtual ~Observer() = default;
  /// `amount` units of work (vertices times levels) are done.
  virtual void worked(std::int64_t amount) { (void)amount; }
  /// A stretch of a computation, by its name, took so long: by the clock on the wall, and of all
  /// the process's threads together.
  virtual void timed(std::string_view stretch, double seconds, double cpu_seconds) {
    (void)stretch;
    (void)seconds;
    (void)cpu_seconds;
  }
  /// A task of a graph ended; `error` is empty when it succeeded.
  virtual void task_ended(std::string_view task, std::string_view error) {
    (void)task;
    (void)error;
  }
};

}  // namespace semigeo::engine
