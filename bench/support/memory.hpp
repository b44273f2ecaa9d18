#pragma once

#include <benchmark/benchmark.h>

#include <cstdint>

namespace semigeo::bench {

/// Peak resident memory of the process since this object was made, as Linux counts it. What was
/// freed before is given back to the system first, so that it does not hide what comes.
class PeakMemory {
 public:
  PeakMemory();

  std::int64_t peak_bytes() const;
  /// Above what was resident when this object was made.
  std::int64_t grown_bytes() const;

 private:
  std::int64_t resident_at_start_;
};

/// Counters peak_memory (bytes, of the process) and bytes_per_vertex (of the growth alone).
void report_memory(benchmark::State& state, const PeakMemory& memory, std::int64_t vertices);

/// Counters vertices_per_second and time_per_vertex (seconds), when each iteration does `vertices`
/// vertices (for levels: vertices times levels) of work.
void report_vertices(benchmark::State& state, std::int64_t vertices);

}  // namespace semigeo::bench
