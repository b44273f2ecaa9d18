#include "bench/accuracy/direction_errors.hpp"

#include <algorithm>
#include <cmath>

#include "bench/support/quantile.hpp"
#include "kernels/surface/circulators.hpp"

namespace semigeo::accuracy {
namespace {

using bench::mean;
using bench::median;
using bench::quantile;

constexpr std::int64_t kVertexBlock = 128;

DirectionSpread spread(const std::vector<double>& values) {
  DirectionSpread s;
  s.mean = mean(values);
  s.min = std::abs(s.mean - values.front());
  for (const double value : values) {
    const double error = std::abs(s.mean - value);
    s.max = std::max(s.max, error);
    s.min = std::min(s.min, error);
    s.average += error / static_cast<double>(values.size());
  }
  return s;
}

/// Collects the errors of one kind of all vertices.
struct Sample {
  std::vector<double> of_vertex;   ///< Errors relative to the curvature of the vertex.
  std::vector<double> of_surface;  ///< Errors relative to the curvature of the surface.

  DirectionErrors::Summary summary() {
    return {mean(of_vertex), median(of_vertex), quantile(of_vertex, 0.95), mean(of_surface),
            median(of_surface)};
  }
};

}  // namespace

std::vector<VertexSpread> direction_spreads(const kernels::PreparedSurface& surface, float step,
                                            kernels::Coordinates coordinates,
                                            engine::Workers& workers) {
  const kernels::Surface& s = surface.surface;
  const kernels::SampledSurface sampled = surface.sampled();
  std::vector<VertexSpread> result(s.vertex_count());
  workers.for_blocks(s.vertex_count(), kVertexBlock, [&](engine::IndexRange range) {
    std::vector<double> gaussian, mean;
    for (auto v = range.begin; v < range.end; ++v) {
      gaussian.clear();
      mean.clear();
      bool whole = true;
      for (const std::int32_t h : kernels::outgoing(s, static_cast<std::int32_t>(v))) {
        const kernels::EvolvedVertex e =
            kernels::evolve_vertex(sampled, static_cast<std::int32_t>(v),
                                   {.step = step, .coordinates = coordinates, .first = h});
        whole = whole && e.patch_completeness == 1;
        gaussian.push_back(e.gaussian_curvature);
        mean.push_back(e.mean_curvature);
        if (!whole) break;
      }
      result[v] = {{spread(gaussian), spread(mean)}, whole};
    }
  });
  return result;
}

DirectionErrors direction_errors(const std::vector<VertexSpread>& spreads, int quantity,
                                 double least) {
  DirectionErrors errors{};
  std::vector<double> sizes;
  for (const VertexSpread& v : spreads)
    if (v.whole) sizes.push_back(std::abs(v.of[quantity].mean));
  const double size = median(sizes);
  Sample max, min, average;
  for (const VertexSpread& v : spreads) {
    if (!v.whole) {
      ++errors.truncated;
      continue;
    }
    const DirectionSpread& s = v.of[quantity];
    const auto enter = [&](Sample& sample, double error) {
      if (size > 0) sample.of_surface.push_back(100 * error / size);
      if (std::abs(s.mean) > 0 && std::abs(s.mean) >= least * size)
        sample.of_vertex.push_back(100 * error / std::abs(s.mean));
      else if (&sample == &max)
        ++errors.near_zero;
    };
    enter(max, s.max);
    enter(min, s.min);
    enter(average, s.average);
  }
  errors.used = static_cast<std::int64_t>(max.of_vertex.size());
  errors.max = max.summary();
  errors.min = min.summary();
  errors.average = average.summary();
  return errors;
}

}  // namespace semigeo::accuracy
