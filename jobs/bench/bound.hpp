#pragma once

#include <string_view>

namespace semigeo::jobs {

/// Names what keeps a figure from being better.
enum class Bound {
  kArithmetic,  ///< The work of one core, which was busy all the time.
  kMemory,      ///< What memory can move.
  kDisk,        ///< Waiting for the disk.
  kLock,        ///< A part that only one thread at a time may do.
  kCores,       ///< The number of cores: all were busy, and more would help.
  kOneCore,     ///< Parts of the work that use one core only.
  kUnclear      ///< The measurements do not tell.
};

/// Returns the name of a bound for people, as "one core".
std::string_view name_of(Bound bound);

/// Holds what is known about a figure. Numbers are means over its repetitions.
struct BoundEvidence {
  int threads = 1;
  double busy = 0;             ///< Cores that it kept busy: CPU time over time on the clock.
  double speedup = 0;          ///< Rate over that of one thread; 0 for one thread, or if unknown.
  double memory = 0;           ///< Share of what memory can move on so many threads; 0 if unknown.
  double locked = 0;           ///< Share of its time in parts that one thread at a time may do.
  bool disturbed = false;      ///< Other processes had cores that it needed.
  bool used_disk = false;      ///< It read from the disk or wrote to it.
  bool alone_on_disk = false;  ///< The same work on one thread is bound by the disk.
};

/// Decides what bounds a figure (docs/bench.md has the rule). What the evidence does not tell is
/// kUnclear.
Bound bound_of(const BoundEvidence& evidence);

}  // namespace semigeo::jobs
