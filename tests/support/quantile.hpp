#pragma once

#include <algorithm>
#include <utility>
#include <vector>

namespace semigeo::tests {

/// The value that a share of the values lies below. There must be some.
inline double quantile(std::vector<double> values, double share) {
  const auto place = std::min(static_cast<std::size_t>(share * static_cast<double>(values.size())),
                              values.size() - 1);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

inline double median(std::vector<double> values) {
  return quantile(std::move(values), 0.5);
}

}  // namespace semigeo::tests
