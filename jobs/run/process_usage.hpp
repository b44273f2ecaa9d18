#pragma once

#include <sys/resource.h>

namespace semigeo::jobs {

/// The time and memory that a process has used so far.
struct ProcessUsage {
  double cpu_seconds = 0;
  double peak_bytes = 0;  ///< Largest use of memory so far.
};

/// Returns what this process has used.
inline ProcessUsage process_usage() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return {.cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime),
          .peak_bytes = 1024.0 * static_cast<double>(usage.ru_maxrss)};
}

}  // namespace semigeo::jobs
