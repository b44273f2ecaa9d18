#include "jobs/stages/library_runs.hpp"

#include <string>

#include "io/files/error.hpp"
#include "io/library/posting_partition.hpp"

namespace semigeo::jobs {
namespace {

constexpr std::int64_t kRunsAtOnce = 64;
constexpr std::int64_t kDefaultMemory = std::int64_t{512} << 20;

}  // namespace

std::uint64_t for_each_run(const std::vector<std::filesystem::path>& runs, engine::Workers& workers,
                           const std::function<void(std::size_t, const io::TripletRun&)>& use) {
  std::vector<std::string> names(runs.size());
  std::vector<std::uint64_t> hashes(runs.size());
  workers.for_blocks(static_cast<std::int64_t>(runs.size()), kRunsAtOnce,
                     [&](engine::IndexRange range) {
                       for (auto i = static_cast<std::size_t>(range.begin);
                            i < static_cast<std::size_t>(range.end); ++i) {
                         const io::TripletRun run(runs[i]);
                         names[i] = run.name();
                         hashes[i] = run.content_hash();
                         use(i, run);
                       }
                     });
  for (std::size_t i = 1; i < names.size(); ++i)
    if (names[i] <= names[i - 1])
      throw io::Error(runs[i], "", "its model " + names[i] + " does not come after " + names[i - 1],
                      "give each model once, in the order of their names");
  return io::runs_hash(hashes);
}

std::vector<engine::IndexRange> batches_of(std::span<const std::int64_t> sizes,
                                           std::int64_t capacity) {
  std::vector<engine::IndexRange> batches;
  std::int64_t filled = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const auto index = static_cast<std::int64_t>(i);
    if (batches.empty() || filled + sizes[i] > capacity) {
      batches.push_back({index, index});
      filled = 0;
    }
    batches.back().end = index + 1;
    filled += sizes[i];
  }
  return batches;
}

std::int64_t memory_or_default(std::int64_t memory_bytes) {
  return memory_bytes > 0 ? memory_bytes : kDefaultMemory;
}

}  // namespace semigeo::jobs
