#pragma once

#include <benchmark/benchmark.h>

#include <cstdint>

namespace semigeo::bench {

/// Measures the peak resident memory of the process since this object was made, as Linux counts it.
/// Memory that was freed before is given back to the system first, so that it hides no growth.
class PeakMemory {
 public:
  PeakMemory();

  /// Returns the peak in bytes.
  std::int64_t peak_bytes() const;
  /// Returns by how many bytes the peak exceeds what was resident when this object was made.
  std::int64_t grown_bytes() const;

 private:
  std::int64_t resident_at_start_;
};

/// Sets the counters peak_memory (bytes of the process) and bytes_per_vertex (of the growth alone).
void report_memory(benchmark::State& state, const PeakMemory& memory, std::int64_t vertices);

/// Sets the counters vertices_per_second and time_per_vertex (seconds). Each iteration does the
/// work of `vertices` vertices (for levels: vertices times levels).
void report_vertices(benchmark::State& state, std::int64_t vertices);

}  // namespace semigeo::bench
