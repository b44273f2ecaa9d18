#pragma once

#include <cstdint>
#include <functional>
#include <memory>

namespace semigeo::engine {

/// Indices begin, ..., end - 1.
struct IndexRange {
  std::int64_t begin;
  std::int64_t end;
};

/// A bounded set of threads that share index ranges and tasks. All parallelism goes through here,
/// so that the library behind it can be exchanged (oneTBB, or std::thread where a sanitizer must
/// see every synchronisation). Thread-safe; may be used from inside its own tasks.
class Workers {
 public:
  /// At most `threads` at once, the caller's included; 0 means one per available core.
  explicit Workers(int threads = 0);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int threads() const { return threads_; }

  /// Calls body on consecutive blocks of `block` indices (the last may be shorter) that cover
  /// [0, count), in any order, on any thread; returns when all are done. Which blocks there are
  /// does not depend on the number of threads, so results stored per block reduce to the same
  /// value. The first exception stops the handing out of blocks and is rethrown here.
  void for_blocks(std::int64_t count, std::int64_t block,
                  const std::function<void(IndexRange)>& body);

  /// Tasks that may start more tasks, the one given last preferred. Tasks must not throw.
  class Group {
   public:
    virtual ~Group() = default;
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
