#pragma once

#include "engine/child_process.hpp"

namespace semigeo::jobs {

/// Counts SIGINT and SIGTERM as long as it exists. They do not end the process, but wake the thread
/// that waits for children. The destructor restores what the signals did before. There may be only
/// one Drain at a time.
class Drain {
 public:
  explicit Drain(engine::ChildProcesses& children);
  ~Drain();
  Drain(const Drain&) = delete;
  Drain& operator=(const Drain&) = delete;

  /// Returns the number of signals so far. After one, nothing new should start; after two, running
  /// jobs should be ended.
  int requests() const;
};

}  // namespace semigeo::jobs
