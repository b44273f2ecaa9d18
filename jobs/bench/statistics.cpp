#include "jobs/bench/statistics.hpp"

#include <algorithm>
#include <vector>

namespace semigeo::jobs {
namespace {

/// One extreme of so many repetitions is set aside at each end.
constexpr std::size_t kRepetitionsPerExtreme = 7;

double middle_of(const std::vector<double>& sorted) {
  const std::size_t n = sorted.size();
  return (sorted[(n - 1) / 2] + sorted[n / 2]) / 2;
}

std::vector<double> sorted_copy(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  return sorted;
}

}  // namespace

Spread spread_of(std::span<const double> values) {
  if (values.empty()) return {};
  const std::vector<double> sorted = sorted_copy(values);
  const std::size_t aside = sorted.size() / kRepetitionsPerExtreme;
  return {.median = middle_of(sorted),
          .min = sorted.front(),
          .max = sorted.back(),
          .low = sorted[aside],
          .high = sorted[sorted.size() - 1 - aside]};
}

double median_of(std::span<const double> values) {
  return values.empty() ? 0 : middle_of(sorted_copy(values));
}

}  // namespace semigeo::jobs
