#pragma once

#include <span>

namespace semigeo::jobs {

/// Holds what the repetitions of one measurement say together.
struct Spread {
  double median = 0;
  double min = 0;
  double max = 0;
  /// `low` and `high` are the ends of the range without its extremes. A seventh of the repetitions
  /// is set aside at each end, rounded down. Below seven repetitions none is.
  double low = 0;
  double high = 0;

  /// Returns half of the distance from `low` to `high` as a share of the median; 0 if that is 0.
  double relative() const { return median == 0 ? 0 : (high - low) / (2 * median); }
};

/// Returns the spread of some values in any order; all zero if there are none.
Spread spread_of(std::span<const double> values);

/// Returns the median of some values in any order, the mean of the two in the middle if their
/// number is even; 0 if there are none.
double median_of(std::span<const double> values);

}  // namespace semigeo::jobs
