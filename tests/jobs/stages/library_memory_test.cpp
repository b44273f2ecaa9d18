// However much a library has, its jobs keep to the memory that they are given. A program of its
// own: it counts what operator new hands out.
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<std::int64_t> in_use = 0;
std::atomic<std::int64_t> peak = 0;

void* counted(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  const std::int64_t now = in_use += static_cast<std::int64_t>(malloc_usable_size(memory));
  for (std::int64_t before = peak; before < now && !peak.compare_exchange_weak(before, now);) {
  }
  return memory;
}
}  // namespace

[[gnu::noinline]] void* operator new(std::size_t bytes) {
  return counted(std::malloc(bytes));
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  in_use -= static_cast<std::int64_t>(malloc_usable_size(memory));
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  operator delete(memory);
}

#include <gtest/gtest.h>

#include "io/library/triplet_run.hpp"
#include "jobs/stages/library_job.hpp"
#include "jobs/stages/partition_job.hpp"
#include "tests/support/generated_models.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

constexpr std::int64_t kMemory = 6 << 20;
// Cell counts, heads, buffers of files, two blocks: whatever the library's size.
constexpr std::int64_t kFixed = 20 << 20;

/// What is in use at most while `action` runs, above what was before.
template <typename Action>
std::int64_t peak_of(const Action& action) {
  const std::int64_t before = in_use;
  peak = before;
  action();
  return peak - before;
}

struct Peaks {
  std::int64_t partition = 0;
  std::int64_t library = 0;
};

Peaks build(int models, int threads) {
  const tests::TemporaryFolder folder;
  const tests::ModelSize size{.features = 100, .samples = 1000, .triplets = 4000};
  PartitionJob partition{.runs = {},
                         .shapes = {},
                         .output = folder / "partition",
                         .key = "key",
                         .memory_bytes = kMemory};
  for (int i = 0; i < models; ++i) {
    const kernels::RecognitionModel model = tests::generated_model(i, size);
    partition.runs.push_back(folder / std::to_string(i));
    io::write_triplet_run(partition.runs.back(), "key", model,
                          tests::generated_triplets(i, model, size));
  }
  const LibraryJob library{.runs = partition.runs,
                           .partitions = {partition.output},
                           .parameters = nlohmann::json::object(),
                           .output = folder / "library.h5",
                           .key = "key",
                           .memory_bytes = kMemory};
  engine::Workers workers(threads);
  engine::Observer observer;
  const engine::RunContext context{workers, observer, {}};
  Peaks peaks;
  peaks.partition = peak_of([&] { run_partition_job(partition, context); });
  peaks.library = peak_of([&] { run_library_job(library, context); });
  return peaks;
}

constexpr int kLarge = 400;  // 1.6 million postings, 41 MB

TEST(LibraryMemory, IsBounded) {
  const Peaks large = build(kLarge, 2);
  EXPECT_LT(large.partition, kMemory + kFixed);
  EXPECT_LT(large.library, kMemory + kFixed);
}

// On one thread: how many blocks two threads hold at the same time depends on when they run.
TEST(LibraryMemory, DoesNotGrowWithTheLibrary) {
  const Peaks small = build(kLarge / 4, 1);
  const Peaks large = build(kLarge, 1);
  EXPECT_LT(large.partition, small.partition + 300 * 1000) << "1 kB a model at most";
  EXPECT_LT(large.library, small.library + 300 * 1000);
}

}  // namespace
}  // namespace semigeo::jobs
