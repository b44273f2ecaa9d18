#pragma once

#include <cstdint>
#include <functional>
#include <memory>

namespace semigeo::engine {

/// The indices begin, ..., end - 1.
struct IndexRange {
  std::int64_t begin;
  std::int64_t end;
};

/// Runs index ranges and tasks on a bounded set of threads. All parallelism goes through here, so
/// that the library behind it can be exchanged (oneTBB, or std::thread where a sanitizer must see
/// every synchronisation). The class is thread-safe, and its own tasks may use it.
class Workers {
 public:
  /// Uses at most `threads` threads at once, including the caller's; 0 means one for each available
  /// core.
  explicit Workers(int threads = 0);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int threads() const { return threads_; }

  /// Calls `body` on consecutive blocks of `block` indices (the last may be shorter) that cover [0,
  /// count), in any order, on any thread. Returns when all are done. Which blocks there are does
  /// not depend on the number of threads, so results that are stored for each block reduce to the
  /// same value. The first exception stops the handing out of blocks and is rethrown here.
  void for_blocks(std::int64_t count, std::int64_t block,
                  const std::function<void(IndexRange)>& body);

  /// Runs tasks that may start more tasks. The task that was given last is preferred. Tasks must
  /// not throw.
  class Group {
   public:
    virtual ~Group() = default;
    /// Adds a task. Tasks call it, too.
    virtual void run(std::function<void()> task) = 0;
  };
  /// Calls `start` with a group and returns when every task of the group has ended.
  void run_group(const std::function<void(Group&)>& start);

 private:
  struct Backend;
  int threads_;
  std::unique_ptr<Backend> backend_;
};

}  // namespace semigeo::engine
