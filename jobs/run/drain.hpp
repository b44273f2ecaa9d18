#pragma once

#include "engine/child_process.hpp"

namespace semigeo::jobs {

/// Counts SIGINT and SIGTERM while a run is prepared, so that no file is left half written. They do
/// not end the process. A Drain that is made meanwhile goes on counting. The destructor restores
/// what the signals did before. There may be only one at a time.
class EarlySignals {
 public:
  EarlySignals();
  ~EarlySignals();
  EarlySignals(const EarlySignals&) = delete;
  EarlySignals& operator=(const EarlySignals&) = delete;
};

/// As long as it exists, SIGINT and SIGTERM call a function that ends the process. It is made where
/// much time may pass and nothing is written. It needs EarlySignals. A signal that came before it
/// ends the process as well.
class EndAtOnce {
 public:
  /// `end` may call only what a signal handler may call. It must not return.
  explicit EndAtOnce(void (*end)());
  ~EndAtOnce();
  EndAtOnce(const EndAtOnce&) = delete;
  EndAtOnce& operator=(const EndAtOnce&) = delete;
};

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
