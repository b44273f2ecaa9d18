// The oneTBB back end of engine/parallel.
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "engine/parallel.hpp"

namespace semigeo::engine {

struct Workers::Backend {
  explicit Backend(int threads) : arena(threads) {
    // oneTBB starts no more threads than there are cores unless told so.
    if (threads > tbb::info::default_concurrency())
      more_threads.emplace(tbb::global_control::max_allowed_parallelism, threads);
  }
  tbb::task_arena arena;
  std::optional<tbb::global_control> more_threads;
};

Workers::Workers(int threads)
    : threads_(threads > 0 ? threads : tbb::info::default_concurrency()),
      backend_(std::make_unique<Backend>(threads_)) {}

Workers::~Workers() = default;

void Workers::for_blocks(std::int64_t count, std::int64_t block,
                         const std::function<void(IndexRange)>& body) {
  const std::int64_t blocks = (count + block - 1) / block;
  backend_->arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, blocks),
                      [&](const tbb::blocked_range<std::int64_t>& range) {
                        for (std::int64_t b = range.begin(); b < range.end(); ++b)
                          body({b * block, std::min(count, (b + 1) * block)});
                      });
  });
}

void Workers::run_group(const std::function<void(Group&)>& start) {
  struct TbbGroup : Group {
    explicit TbbGroup(tbb::task_group& group) : tasks(group) {}
    void run(std::function<void()> task) override { tasks.run(std::move(task)); }
    tbb::task_group& tasks;
  };
  backend_->arena.execute([&] {
    tbb::task_group tasks;
    TbbGroup group(tasks);
    start(group);
    tasks.wait();
  });
}

}  // namespace semigeo::engine
