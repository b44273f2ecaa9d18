// The std::thread back end of engine/parallel. Every synchronisation is visible to a sanitizer. It
// is meant for tests, as it starts threads anew for every call.
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "engine/parallel.hpp"

namespace semigeo::engine {

struct Workers::Backend {};

Workers::Workers(int threads)
    : threads_(threads > 0 ? threads
                           : std::max(1, static_cast<int>(std::thread::hardware_concurrency()))) {}

Workers::~Workers() = default;

void Workers::for_blocks(std::int64_t count, std::int64_t block,
                         const std::function<void(IndexRange)>& body) {
  const std::int64_t blocks = (count + block - 1) / block;
  std::atomic<std::int64_t> next_block{0};
  std::mutex mutex;
  std::exception_ptr error;
  const auto work = [&] {
    try {
      for (std::int64_t b; (b = next_block.fetch_add(1)) < blocks;)
        body({b * block, std::min(count, (b + 1) * block)});
    } catch (...) {
      next_block = blocks;
      const std::scoped_lock lock(mutex);
      if (!error) error = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (std::int64_t t = 1; t < std::min<std::int64_t>(threads_, blocks); ++t)
      helpers.emplace_back(work);
    work();
  }
  if (error) std::rethrow_exception(error);
}

void Workers::run_group(const std::function<void(Group&)>& start) {
  struct QueueGroup : Group {
    std::mutex mutex;
    std::condition_variable changed;
    std::deque<std::function<void()>> ready;
    int unfinished = 1;  // `start` itself counts as one

    void run(std::function<void()> task) override {
      const std::scoped_lock lock(mutex);
      ready.push_front(std::move(task));
      ++unfinished;
      changed.notify_one();
    }
    void finish_one() {
      const std::scoped_lock lock(mutex);
      if (--unfinished == 0) changed.notify_all();
    }
    void work() {
      std::unique_lock lock(mutex);
      for (;;) {
        changed.wait(lock, [&] { return !ready.empty() || unfinished == 0; });
        if (ready.empty()) return;
        const auto task = std::move(ready.front());
        ready.pop_front();
        lock.unlock();
        task();
        finish_one();
        lock.lock();
      }
    }
  };
  QueueGroup group;
  std::vector<std::jthread> helpers;
  for (int t = 1; t < threads_; ++t) helpers.emplace_back([&] { group.work(); });
  start(group);
  group.finish_one();
  group.work();
}

}  // namespace semigeo::engine
