#pragma once

#include <span>
#include <string>
#include <vector>

#include "jobs/bench/statistics.hpp"

namespace semigeo::jobs {

/// Holds a rate that was measured, and the full name of its figure. More is better.
struct NamedRate {
  std::string name;
  std::string unit;
  Spread rate = {};
  double cpu_rate = 0;     ///< Median of the amount for each second of CPU time; 0 if unknown.
  bool disturbed = false;  ///< Other processes had cores that it needed.
};

/// Holds the rates of one figure before and now.
struct ComparedRate {
  std::string name;
  std::string unit;
  Spread before;
  Spread now;
  double cpu_ratio = 1;    ///< Rate for CPU time now over that before; 1 if unknown.
  bool disturbed = false;  ///< Other processes had cores that it needed now.

  /// Returns the median now over that before.
  double ratio() const { return before.median > 0 ? now.median / before.median : 1; }
  /// Returns whether the ranges before and now, without their extremes, lie apart.
  bool is_beyond_spread() const { return now.high < before.low || now.low > before.high; }
  /// Returns whether the ratio is below `bound`, and the difference is beyond the spread of both.
  bool is_below(double bound) const { return ratio() < bound && now.high < before.low; }
  /// Returns whether it took no more CPU time than `bound` allows, while other processes had cores
  /// that it needed. Then its rate says nothing.
  bool is_disturbed(double bound) const { return disturbed && cpu_ratio >= bound; }
  /// Returns whether the figure fell: it is below the bound, and not because of other processes.
  bool fell_below(double bound) const { return is_below(bound) && !is_disturbed(bound); }
  /// Returns "within spread" if the ranges overlap, otherwise "faster", "slower", or "disturbed" if
  /// it is slower, but takes as much CPU time as before.
  const char* verdict() const;
};

/// Holds two sets of figures, compared by their names.
struct Comparison {
  std::vector<ComparedRate> rates;     ///< Figures that both have, in the order of those now.
  std::vector<std::string> only_now;   ///< Figures that the baseline does not have.
  std::vector<std::string> only_then;  ///< Figures that the baseline has alone.
};

/// Compares figures by their names.
Comparison compare(std::span<const NamedRate> before, std::span<const NamedRate> now);

/// Returns whether a figure measures the machine instead of the program: "machine/...". Such
/// figures say whether two measurements can be compared, and fail nothing.
bool is_of_machine(const std::string& name);

/// Returns the figures of the program that fell below the bound.
std::vector<ComparedRate> fallen(const Comparison& comparison, double bound);

}  // namespace semigeo::jobs
