#include "bench/peers/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "bench/support/quantile.hpp"

namespace semigeo::peers {
namespace {

/// Returns the median of |found - true| / |true|, in per cent. What is not finite is off by
/// everything. Without values or truth it is NaN.
double median_error(const std::vector<double>& found,
                    const std::vector<shapes::SurfacePoint>& truth,
                    double shapes::SurfacePoint::*value) {
  std::vector<double> errors;
  for (std::size_t v = 0; v < std::min(found.size(), truth.size()); ++v) {
    const double error = std::abs((found[v] - truth[v].*value) / (truth[v].*value));
    errors.push_back(std::isfinite(error) ? 100 * error : std::numeric_limits<double>::infinity());
  }
  return bench::median(errors);
}

}  // namespace

std::vector<MethodRow> compare_methods(const Subject& subject,
                                       const std::vector<Library>& libraries, int rounds) {
  std::vector<MethodRow> rows;
  std::vector<std::vector<double>> times;
  for (int round = 0; round < rounds; ++round) {
    std::size_t at = 0;
    for (const Library& library : libraries)
      for (const Method& method : library.methods) {
        const Result result = method.run(subject);
        std::fprintf(stderr, "%s: %s: %s: %.3f s\n", subject.name.c_str(), library.name.c_str(),
                     method.name.c_str(), result.seconds);
        if (round == 0) {
          rows.push_back(
              {subject.name, library.name, method.name, 0, 0,
               median_error(result.gaussian, subject.truth, &shapes::SurfacePoint::gaussian),
               median_error(result.mean, subject.truth, &shapes::SurfacePoint::mean)});
          times.emplace_back();
        }
        times[at++].push_back(1e6 * result.seconds / result.items);
      }
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].least_microseconds = *std::ranges::min_element(times[i]);
    rows[i].median_microseconds = bench::median(times[i]);
  }
  return rows;
}

}  // namespace semigeo::peers
