#pragma once

#include <chrono>
#include <ctime>
#include <string_view>

#include "engine/observer.hpp"

namespace semigeo::engine {

/// Measures the time of the scope that holds it, and reports it to an observer at the end.
class Stopwatch {
 public:
  /// Begins to measure. `stretch` and the observer must outlive this object.
  Stopwatch(Observer& observer, std::string_view stretch)
      : observer_(observer), stretch_(stretch), start_(Clock::now()), cpu_start_(std::clock()) {}
  ~Stopwatch() {
    observer_.timed(stretch_, std::chrono::duration<double>(Clock::now() - start_).count(),
                    static_cast<double>(std::clock() - cpu_start_) / CLOCKS_PER_SEC);
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  Observer& observer_;
  std::string_view stretch_;
  Clock::time_point start_;
  std::clock_t cpu_start_;
};

}  // namespace semigeo::engine
