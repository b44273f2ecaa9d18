#pragma once

#include <span>
#include <vector>

namespace semigeo::jobs {

/// Says how often cases are measured.
struct RepetitionLimits {
  int least = 5;       ///< Every case is measured so often, whatever it costs.
  int most = 15;       ///< No case is measured more often.
  double seconds = 0;  ///< Time for all repetitions together, unless `least` takes more.
};

/// Returns the order in which cases are measured: entry i is the index of a case. `seconds` is the
/// time that one repetition of each case takes. Time that is left is given to the cases with the
/// fewest repetitions, the cheapest first. The repetitions of each case lie evenly in the whole
/// time, so that a minute in which the machine is busy hits few repetitions of many cases instead
/// of all of one.
std::vector<int> interleaved(std::span<const double> seconds, const RepetitionLimits& limits);

}  // namespace semigeo::jobs
