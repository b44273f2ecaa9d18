#include "kernels/extrema.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace semigeo::kernels {

std::int32_t uphill(const Surface& surface, const CurvatureField& field, std::int32_t v) {
  if (!field.comparable(v, v)) return kNone;
  std::int32_t best = v;
  const std::int32_t start = surface.outgoing[v];
  std::int32_t h = start;
  do {
    for (const std::int32_t w : {surface.target(h), surface.origin(prev(h))})
      if (field.comparable(v, w) && field.higher(w, best)) best = w;
    h = surface.ccw(h);
  } while (h != kNone && h != start);
  return best;
}

bool is_maximum(const Surface& surface, std::span<const Eigen::Vector4f> points,
                const CurvatureField& field, std::int32_t v, double radius, GeodesicBall& ball) {
  if (uphill(surface, field, v) != v) return false;
  if (!(radius > 0)) return true;
  bool highest = true;
  ball.grow(surface, points, v, radius, [&](std::int32_t w, double) {
    highest = w == v || !field.comparable(v, w) || field.higher(v, w);
    return highest;
  });
  return highest;
}

std::vector<std::int32_t> peaks_of(std::vector<std::int32_t> uphill) {
  for (std::size_t v = 0; v < uphill.size(); ++v) {
    if (uphill[v] == kNone) continue;
    std::int32_t peak = uphill[v];
    while (uphill[peak] != peak) peak = uphill[peak];
    // Everything on the way now points to the peak itself.
    for (auto w = static_cast<std::int32_t>(v); uphill[w] != peak;) {
      const std::int32_t next = uphill[w];
      uphill[w] = peak;
      w = next;
    }
  }
  return uphill;
}

std::vector<float> prominences(const Surface& surface, const CurvatureField& field,
                               std::span<const std::int32_t> peaks) {
  // Passes: edges between the slopes of two peaks, as high as their lower end.
  struct Pass {
    float height;
    std::int32_t first;
    std::int32_t second;
  };
  std::vector<Pass> passes;
  for (std::int32_t f = 0; f < surface.face_count(); ++f)
    for (int i = 0; i < 3; ++i) {
      const std::int32_t h = halfedge(f, i);
      if (surface.twin[h] > h) continue;  // seen from the other side
      const std::int32_t v = surface.origin(h);
      const std::int32_t w = surface.target(h);
      if (peaks[v] == peaks[w] || !field.comparable(v, w)) continue;
      passes.push_back({std::min(field.magnitude(v), field.magnitude(w)), peaks[v], peaks[w]});
    }
  std::sort(passes.begin(), passes.end(), [](const Pass& a, const Pass& b) {
    if (a.height != b.height) return a.height > b.height;
    return std::pair(a.first, a.second) < std::pair(b.first, b.second);
  });

  // The sea falls: at each pass the lower of two islands becomes part of the higher one.
  std::vector<float> result(peaks.size(), 0.0f);
  std::vector<std::int32_t> island(peaks.size());
  std::iota(island.begin(), island.end(), 0);
  const auto summit = [&](std::int32_t v) {
    while (island[v] != v) {
      island[v] = island[island[v]];
      v = island[v];
    }
    return v;
  };
  for (std::size_t v = 0; v < peaks.size(); ++v)
    if (peaks[v] == static_cast<std::int32_t>(v)) result[v] = field.magnitude(peaks[v]);
  for (const Pass& pass : passes) {
    std::int32_t high = summit(pass.first);
    std::int32_t low = summit(pass.second);
    if (high == low) continue;
    if (field.higher(low, high)) std::swap(low, high);
    result[low] = field.magnitude(low) - pass.height;
    island[low] = high;
  }
  return result;
}

}  // namespace semigeo::kernels
