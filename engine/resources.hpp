#pragma once

#include <cstdint>

namespace semigeo::engine {

/// An amount of cores and of memory: of a machine, or for a job.
struct Amount {
  int cores = 0;
  std::uint64_t bytes = 0;
};

/// Decides what may run side by side. The class is not thread-safe. The caller chooses what to ask
/// for next: if it goes on with small jobs whenever a large one is refused, the large one waits for
/// long.
class Resources {
 public:
  explicit Resources(Amount total) : total_(total) {}

  /// Returns whether a job that takes `wanted` may start now; if so, its share is taken. The
  /// running jobs together never take more than the total. The one exception is a job that alone
  /// takes more: it is admitted when nothing else runs, and nothing else is admitted until its
  /// release.
  bool admit(Amount wanted);
  /// Gives back what was admitted. Throws std::logic_error if less is in use.
  void release(Amount wanted);

  int running() const { return running_; }
  Amount in_use() const { return in_use_; }

 private:
  bool fits(Amount wanted) const;

  Amount total_;
  Amount in_use_;
  int running_ = 0;
};

}  // namespace semigeo::engine
