#include <algorithm>
#include <array>
#include <atomic>
#include <span>
#include <string>

#include "io/files/atomic_file.hpp"
#include "jobs/bench/cases.hpp"

namespace semigeo::jobs {
namespace {

constexpr std::int64_t kRounds = 4'000'000;  // of the loop over the sums, each thread
constexpr int kSums = 16;
constexpr std::int64_t kTriadBlock = 1 << 16;

/// Multiplies and adds in registers, which is what a core can do if it waits for nothing.
BenchWork arithmetic(engine::Workers& workers) {
  std::atomic<int> overflows = 0;
  workers.for_blocks(workers.threads(), 1, [&](engine::IndexRange) {
    std::array<float, kSums> sums;
    for (int i = 0; i < kSums; ++i) sums[i] = static_cast<float>(i);
    for (std::int64_t k = 0; k < kRounds; ++k)
      for (float& sum : sums) sum = sum * 0.75F + 0.5F;
    // The sums are used, so that the compiler keeps the loop.
    if (std::ranges::any_of(sums, [](float sum) { return sum > 1e6F; })) ++overflows;
  });
  const double operations = 2.0 * kSums * kRounds * workers.threads();
  return {.amount = 1e-9 * operations + overflows, .memory_bytes = 1};
}

/// Holds the arrays of a triad, a[i] = b[i] + 3 c[i].
struct Triad {
  explicit Triad(std::int64_t bytes) : a(bytes / sizeof(double)), b(a.size(), 1), c(a.size(), 2) {}
  std::vector<double> a, b, c;
};

BenchWork triad(Triad& arrays, engine::Workers& workers) {
  const auto count = static_cast<std::int64_t>(arrays.a.size());
  workers.for_blocks(count, kTriadBlock, [&](engine::IndexRange range) {
    double* a = arrays.a.data();
    const double* b = arrays.b.data();
    const double* c = arrays.c.data();
    for (auto i = range.begin; i < range.end; ++i) a[i] = b[i] + 3 * c[i];
  });
  const double bytes = 3.0 * sizeof(double) * static_cast<double>(count);
  return {.amount = 1e-9 * bytes, .memory_bytes = bytes};
}

/// Returns a case that writes a file of so many bytes and forces it to the disk.
BenchCase file_case(const char* name, const char* unit, const BenchInputsPointer& inputs,
                    std::int64_t bytes, double amount) {
  const auto content = std::make_shared<std::string>();
  return {
      .name = name,
      .unit = unit,
      .run = [=](engine::Workers&) -> BenchWork {
        io::write_file_atomically(inputs->folder() / "file", *content);
        return {.amount = amount};
      },
      .prepare = [=](engine::Workers&) { content->resize(static_cast<std::size_t>(bytes), 'x'); }};
}

}  // namespace

void add_machine_cases(std::vector<BenchCase>& cases, const BenchInputsPointer& inputs,
                       const std::vector<int>& threads) {
  for (const int count : threads)
    cases.push_back(
        {.name = "machine/arithmetic", .unit = "Gflop/s", .threads = count, .run = arithmetic});
  const auto arrays = std::make_shared<std::unique_ptr<Triad>>();
  for (const int count : threads)
    cases.push_back({.name = "machine/memory",
                     .unit = "GB/s",
                     .threads = count,
                     .run = [arrays](engine::Workers& workers) { return triad(**arrays, workers); },
                     .prepare =
                         [arrays, inputs](engine::Workers&) {
                           if (!*arrays)
                             *arrays = std::make_unique<Triad>(inputs->sizes().memory_bytes);
                         }});
  cases.push_back(file_case("machine/disk", "MB/s", inputs, inputs->sizes().disk_bytes,
                            1e-6 * static_cast<double>(inputs->sizes().disk_bytes)));
  cases.push_back(file_case("machine/files", "files/s", inputs, 4096, 1));
}

}  // namespace semigeo::jobs
