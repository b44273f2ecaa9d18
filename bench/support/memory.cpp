#include "bench/support/memory.hpp"

#include <malloc.h>

#include <fstream>
#include <stdexcept>
#include <string>

namespace semigeo::bench {
namespace {

/// Returns the number of bytes in a line of /proc/self/status, which counts kB.
std::int64_t status_bytes(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string key; status >> key; status.ignore(1 << 20, '\n')) {
    std::int64_t kilobytes = 0;
    if (key == name + ":" && status >> kilobytes) return 1024 * kilobytes;
  }
  throw std::runtime_error("/proc/self/status has no " + name);
}

}  // namespace

PeakMemory::PeakMemory() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5\n";  // starts VmHWM anew
  resident_at_start_ = status_bytes("VmRSS");
}

std::int64_t PeakMemory::peak_bytes() const {
  return status_bytes("VmHWM");
}

std::int64_t PeakMemory::grown_bytes() const {
  return peak_bytes() - resident_at_start_;
}

void report_memory(benchmark::State& state, const PeakMemory& memory, std::int64_t vertices) {
  using benchmark::Counter;
  state.counters["peak_memory"] =
      Counter(static_cast<double>(memory.peak_bytes()), Counter::kDefaults, Counter::kIs1024);
  state.counters["bytes_per_vertex"] =
      static_cast<double>(memory.grown_bytes()) / static_cast<double>(vertices);
}

void report_vertices(benchmark::State& state, std::int64_t vertices) {
  using benchmark::Counter;
  const auto amount = static_cast<double>(vertices);
  state.counters["vertices_per_second"] = Counter(amount, Counter::kIsIterationInvariantRate);
  state.counters["time_per_vertex"] =
      Counter(amount, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

}  // namespace semigeo::bench
