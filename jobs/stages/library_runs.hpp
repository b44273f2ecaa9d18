#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "engine/parallel.hpp"
#include "io/library/triplet_run.hpp"

namespace semigeo::jobs {

/// Calls use(i, run) for each run, on any thread and in any order, and returns io::runs_hash of all
/// runs. Throws io::Error if a run is damaged, or if the names of the models do not ascend.
std::uint64_t for_each_run(const std::vector<std::filesystem::path>& runs, engine::Workers& workers,
                           const std::function<void(std::size_t, const io::TripletRun&)>& use);

/// Cuts [0, sizes.size()) into consecutive ranges. The sizes of a range add up to `capacity` at
/// most, unless it holds one index alone.
std::vector<engine::IndexRange> batches_of(std::span<const std::int64_t> sizes,
                                           std::int64_t capacity);

/// Returns the limit that `memory_bytes` of PartitionJob or LibraryJob stands for: 0 stands for
/// 512 MiB.
std::int64_t memory_or_default(std::int64_t memory_bytes);

/// Calls make(i) for all i < count on several threads, and write(result) in the order of i on one
/// thread at a time, as HDF5 needs it. While `at_once` results are written, the next ones are made.
template <typename Make, typename Write>
void make_and_write(std::int64_t count, std::int64_t at_once, engine::Workers& workers,
                    const Make& make, const Write& write) {
  using Made = decltype(make(std::int64_t{}));
  std::vector<Made> ready;
  std::int64_t next = 0;
  while (next < count || !ready.empty()) {
    const std::int64_t making = std::min(at_once, count - next);
    std::vector<Made> made(static_cast<std::size_t>(making));
    workers.for_blocks(making + 1, 1, [&](engine::IndexRange range) {
      for (auto i = range.begin; i < range.end; ++i)
        if (i > 0)
          made[i - 1] = make(next + i - 1);
        else
          for (const Made& one : ready) write(one);
    });
    ready = std::move(made);
    next += making;
  }
}

}  // namespace semigeo::jobs
