#include "engine/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace semigeo::engine {
namespace {

class ParallelTest : public testing::TestWithParam<int> {};

TEST_P(ParallelTest, BlocksCoverEveryIndexOnce) {
  Workers workers(GetParam());
  for (const std::int64_t count : {0, 1, 7, 64, 65, 1000}) {
    std::vector<std::atomic<int>> hits(count);
    workers.for_blocks(count, 64, [&](IndexRange range) {
      EXPECT_LE(range.end - range.begin, 64);
      EXPECT_EQ(range.begin % 64, 0);
      for (auto i = range.begin; i < range.end; ++i) ++hits[i];
    });
    for (const auto& hit : hits) EXPECT_EQ(hit, 1);
  }
}

TEST_P(ParallelTest, BlocksNest) {
  Workers workers(GetParam());
  std::atomic<std::int64_t> sum = 0;
  workers.for_blocks(10, 1, [&](IndexRange outer) {
    workers.for_blocks(100, 7, [&](IndexRange inner) {
      for (auto i = inner.begin; i < inner.end; ++i) sum += outer.begin * 100 + i;
    });
  });
  EXPECT_EQ(sum, 1000 * 999 / 2);
}

TEST_P(ParallelTest, AnExceptionReachesTheCaller) {
  Workers workers(GetParam());
  EXPECT_THROW(workers.for_blocks(1000, 1,
                                  [](IndexRange range) {
                                    if (range.begin == 500) throw std::runtime_error("block 500");
                                  }),
               std::runtime_error);
  std::atomic<int> blocks = 0;  // and the workers still work
  workers.for_blocks(10, 1, [&](IndexRange) { ++blocks; });
  EXPECT_EQ(blocks, 10);
}

TEST_P(ParallelTest, GroupWaitsForTasksThatTasksStarted) {
  Workers workers(GetParam());
  std::atomic<int> ran = 0;
  workers.run_group([&](Workers::Group& group) {
    for (int i = 0; i < 8; ++i)
      group.run([&] {
        ++ran;
        for (int j = 0; j < 8; ++j) group.run([&] { ++ran; });
      });
  });
  EXPECT_EQ(ran, 72);
}

TEST_P(ParallelTest, ConcurrencyIsBounded) {
  Workers workers(GetParam());
  std::atomic<int> inside = 0;
  std::atomic<int> most = 0;
  workers.for_blocks(2000, 1, [&](IndexRange) {
    const int now = ++inside;
    int seen = most;
    while (now > seen && !most.compare_exchange_weak(seen, now)) {
    }
    --inside;
  });
  EXPECT_LE(most, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Threads, ParallelTest, testing::Values(1, 2, 4));

}  // namespace
}  // namespace semigeo::engine
