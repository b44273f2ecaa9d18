#include "jobs/bench/schedule.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace semigeo::jobs {
namespace {

/// Returns how often each case is measured.
std::vector<int> repetitions(std::span<const double> seconds, const RepetitionLimits& limits) {
  std::vector<std::size_t> cheapest_first(seconds.size());
  std::iota(cheapest_first.begin(), cheapest_first.end(), std::size_t{0});
  std::ranges::stable_sort(cheapest_first, {}, [&](std::size_t i) { return seconds[i]; });
  double left = limits.seconds;
  for (const double each : seconds) left -= limits.least * each;
  std::vector<int> counts(seconds.size(), limits.least);
  for (int more = limits.least; more < limits.most; ++more)
    for (const std::size_t i : cheapest_first)
      if (counts[i] == more && seconds[i] <= left) {
        ++counts[i];
        left -= seconds[i];
      }
  return counts;
}

}  // namespace

std::vector<int> interleaved(std::span<const double> seconds, const RepetitionLimits& limits) {
  const std::vector<int> counts = repetitions(seconds, limits);
  std::vector<std::pair<double, int>> moments;
  for (std::size_t i = 0; i < counts.size(); ++i)
    for (int k = 0; k < counts[i]; ++k)
      moments.emplace_back((k + 0.5) / counts[i], static_cast<int>(i));
  std::ranges::stable_sort(moments, {}, &std::pair<double, int>::first);
  std::vector<int> order;
  order.reserve(moments.size());
  for (const auto& [moment, i] : moments) order.push_back(i);
  return order;
}

}  // namespace semigeo::jobs
