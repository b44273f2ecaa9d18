#pragma once

#include <algorithm>
#include <limits>
#include <vector>

namespace semigeo::bench {

/// Returns the value that the share q of all values does not exceed, or NaN if there are none. It
/// changes the order of the values.
inline double quantile(std::vector<double>& values, double q) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto at = values.begin() +
                  static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Returns the median as `quantile` does.
inline double median(std::vector<double>& values) {
  return quantile(values, 0.5);
}

/// Returns the mean, or NaN if there are no values.
inline double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? std::numeric_limits<double>::quiet_NaN()
                        : sum / static_cast<double>(values.size());
}

}  // namespace semigeo::bench
