#include "kernels/surface/surface.hpp"

#include <algorithm>
#include <limits>

#include "kernels/surface/circulators.hpp"

namespace semigeo::kernels {

/// The length of an outlier, in medians. The longest edges of 34 scans and models, uneven ones
/// among them, have 19.6.
constexpr double kOutlier = 20;
/// The largest share of outliers. Two per cent of the edges end at the one per cent of pixels that
/// a range scanner misses.
constexpr double kMostOutliers = 0.1;

void connect(Surface& surface) {
  choose_outgoing(surface, std::ssize(surface.points));
  surface.part_count = number_parts(surface, surface.part);
}

EdgeLengths edge_lengths(const Surface& surface) {
  std::vector<double> lengths;
  for (const std::int32_t h : edges(surface))
    lengths.push_back((surface.points[surface.target(h)] - surface.points[surface.origin(h)])
                          .cast<double>()
                          .norm());
  if (lengths.empty()) return {};
  std::vector<double> sorted = lengths;
  const auto median = sorted.begin() + std::ssize(sorted) / 2;
  std::nth_element(sorted.begin(), median, sorted.end());
  const double limit = kOutlier * *median;
  const auto outliers = std::ranges::count_if(lengths, [&](double l) { return l > limit; });
  EdgeLengths result;
  if (outliers > 0 &&
      static_cast<double>(outliers) <= kMostOutliers * static_cast<double>(lengths.size()))
    result.limit = limit;
  double sum = 0;
  std::int64_t count = 0;
  for (const double length : lengths) {
    if (length > result.limit) continue;
    sum += length;
    ++count;
  }
  result.mean = sum / static_cast<double>(count);
  return result;
}

}  // namespace semigeo::kernels
