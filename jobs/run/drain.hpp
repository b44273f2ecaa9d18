#pragma once

#include "engine/child_process.hpp"

namespace semigeo::jobs {

/// While one lives, SIGINT and SIGTERM end nothing: they are counted, and wake whoever waits for
/// children. Before and after, signals do what they did. One at a time.
class Drain {
 public:
  explicit Drain(engine::ChildProcesses& children);
  ~Drain();
  Drain(const Drain&) = delete;
  Drain& operator=(const Drain&) = delete;

  /// Signals so far. One: start nothing new. Two: end what is running.
  int requests() const;
};

}  // namespace semigeo::jobs
