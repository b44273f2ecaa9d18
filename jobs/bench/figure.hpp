#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/parallel.hpp"
#include "jobs/bench/bound.hpp"
#include "jobs/bench/statistics.hpp"

namespace semigeo::jobs {

/// Holds what one call of a case has done.
struct BenchWork {
  double amount = 0;          ///< In the unit of the case, without "/s".
  double vertex_levels = 0;   ///< Vertices times levels; 0 if the case has no such number.
  double memory_bytes = 0;    ///< Bytes that memory must move at least; 0 if unknown.
  double locked_seconds = 0;  ///< Time in parts that only one thread at a time may do.
};

/// Describes something to measure, and on how many threads.
struct BenchCase {
  std::string name;  ///< Name without the threads, as "level/scan".
  std::string unit;  ///< Unit of the rate, as "scans/s".
  int threads = 1;
  /// Does the work once and is timed. It may keep the workers for its next call.
  std::function<BenchWork(engine::Workers&)> run;
  /// Makes ready for the next call and is not timed. It may be empty.
  std::function<void(engine::Workers&)> prepare = {};
  bool in_children = false;  ///< Child processes do the work.
};

/// Holds one repetition, which is some calls of a case, one directly after the other. Numbers are
/// sums over the calls.
struct BenchRepetition {
  int calls = 0;
  double seconds = 0;      ///< Time on the clock.
  double cpu_seconds = 0;  ///< CPU time of the process and of its children.
  double disk_bytes = 0;   ///< Bytes read from disk, or handed over to be written to it.
  double other_cores = 0;  ///< Cores that other processes used meanwhile, on average.
  std::optional<double> queued_seconds = 0;  ///< Time in which threads waited for a core, if known.
  BenchWork work;

  double rate() const { return seconds > 0 ? work.amount / seconds : 0; }
};

/// Holds what was measured of one case.
struct Figure {
  std::string name;
  std::string unit = {};
  int threads = 1;
  std::vector<BenchRepetition> repetitions = {};
  Bound bound = Bound::kUnclear;

  /// Returns the name with the threads, as "level/scan/threads:2".
  std::string full_name() const { return name + "/threads:" + std::to_string(threads); }
  /// Returns the spread of the rate over the repetitions.
  Spread rate() const;
  /// Returns the median of the microseconds for each vertex and level, 0 if there are none.
  double microseconds_per_vertex_level() const;
  /// Returns the median of the amount for each second of CPU time, 0 if it took none.
  double cpu_rate() const;
  /// Returns the cores that it wanted while other processes had them, on average: by the time that
  /// its threads waited for a core or, if that is unknown, by what others used of all cores.
  double missing_cores(int machine_cores) const;
  /// Returns whether these are more than a tenth of its threads.
  bool was_disturbed(int machine_cores) const {
    return missing_cores(machine_cores) > 0.1 * threads;
  }
  /// Returns the cores that other processes used meanwhile, on average.
  double other_cores() const;
  /// Returns the sum of a number over all repetitions.
  double total(double BenchRepetition::*number) const;
  double total(double BenchWork::*number) const;
};

/// Decides for all figures what bounds them. `machine_cores` is the number of cores that
/// BenchRepetition::other_cores counts against. The rate of "machine/memory", in GB/s, is what
/// memory can move.
void find_bounds(std::vector<Figure>& figures, int machine_cores);

}  // namespace semigeo::jobs
