#include "kernels/features/extrema.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "kernels/surface/circulators.hpp"
#include "kernels/surface/nearest_surface.hpp"
#include "kernels/surface/radix_sort.hpp"

namespace semigeo::kernels {
namespace {

/// Tells whether a path of two edges, not longer than `radius`, leads to a comparable vertex that
/// is higher. The distance along the surface is not longer than the path. This test rejects most
/// vertices that are no maximum, at a tenth of the cost of a ball.
bool outdone_two_edges_away(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
                            const CurvatureField& field, std::int32_t v, double radius) {
  const auto length = [&](std::int32_t a, std::int32_t b) {
    return (points[b] - points[a]).cast<double>().norm();
  };
  for (const std::int32_t u : neighbours(surface, v)) {
    const double rest = radius - length(v, u);
    if (!(rest > 0)) continue;
    for (const std::int32_t w : neighbours(surface, u))
      if (w != v && field.comparable(v, w) && field.higher(w, v) && length(u, w) <= rest)
        return true;
  }
  return false;
}

}  // namespace

std::int32_t uphill(const Connectivity& surface, const CurvatureField& field, std::int32_t v) {
  if (!field.comparable(v, v)) return kNone;
  std::int32_t best = v;
  for (const std::int32_t w : neighbours(surface, v))
    if (field.comparable(v, w) && field.higher(w, best)) best = w;
  return best;
}

bool is_maximum(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
                const CurvatureField& field, std::int32_t v, double radius, GeodesicBall& ball) {
  if (uphill(surface, field, v) != v) return false;
  if (!(radius > 0)) return true;
  if (outdone_two_edges_away(surface, points, field, v, radius)) return false;
  bool highest = true;
  const auto outdoes = [&](std::int32_t w) {
    return w != v && field.comparable(v, w) && field.higher(w, v);
  };
  ball.surround(surface, points, v, radius, [&](std::int32_t w) {
    highest = !outdoes(w);
    return highest;
  });
  if (highest) return true;
  highest = true;  // unless it is outdone along the surface as well
  ball.grow(surface, points, v, radius, [&](std::int32_t w, double) {
    highest = !outdoes(w);
    return highest;
  });
  return highest;
}

Summit summit(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
              const CurvatureField& field, std::int32_t v) {
  const auto point = [&](std::int32_t w) -> Eigen::Vector3d {
    return points[w].head<3>().cast<double>();
  };
  float least = field.magnitude(v);
  for (const std::int32_t w : neighbours(surface, v))
    if (field.comparable(v, w)) least = std::min(least, field.magnitude(w));
  double weights = field.magnitude(v) - least;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();  // sum of positions relative to v
  for (const std::int32_t w : neighbours(surface, v)) {
    if (!field.comparable(v, w)) continue;
    weights += field.magnitude(w) - least;
    sum += static_cast<double>(field.magnitude(w) - least) * (point(w) - point(v));
  }

  Summit best{{v, v, v}, {1, 0, 0}};
  if (!(weights > 0)) return best;
  const Eigen::Vector3d centroid = point(v) + sum / weights;
  double nearest2 = (centroid - point(v)).squaredNorm();
  for (const std::int32_t h : outgoing(surface, v)) {
    const std::int32_t a = surface.target(h);
    const std::int32_t b = surface.origin(prev(h));
    const Eigen::Vector3d on_face = nearest_on_triangle(centroid, point(v), point(a), point(b));
    const Eigen::Vector3d normal = (point(a) - point(v)).cross(point(b) - point(v));
    const double distance2 = (on_face - centroid).squaredNorm();
    if (!(distance2 < nearest2 && normal.squaredNorm() > 0)) continue;
    nearest2 = distance2;
    const auto share = [&](std::int32_t p, std::int32_t q) {
      const double area = (point(p) - on_face).cross(point(q) - on_face).dot(normal);
      return static_cast<float>(std::clamp(area / normal.squaredNorm(), 0.0, 1.0));
    };
    const float at_a = share(b, v);
    const float at_b = std::min(share(v, a), 1 - at_a);
    best = {{v, a, b}, {1 - at_a - at_b, at_a, at_b}};
  }
  return best;
}

std::vector<std::int32_t> peaks_of(std::vector<std::int32_t> uphill) {
  for (std::size_t v = 0; v < uphill.size(); ++v) {
    if (uphill[v] == kNone) continue;
    std::int32_t peak = uphill[v];
    while (uphill[peak] != peak) peak = uphill[peak];
    // All vertices on the way are made to point to the peak itself.
    for (auto w = static_cast<std::int32_t>(v); uphill[w] != peak;) {
      const std::int32_t next = uphill[w];
      uphill[w] = peak;
      w = next;
    }
  }
  return uphill;
}

std::vector<float> prominences(const Connectivity& surface, const CurvatureField& field,
                               std::span<const std::int32_t> peaks) {
  // A pass is an edge between the slopes of two peaks. Its height is that of its lower end. Passes
  // are sorted by height, the highest first. Each is one number: the inverted bits of the height,
  // which order positive floats backwards, and the half-edge.
  std::vector<std::uint64_t> passes;
  for (std::int32_t f = 0; f < surface.face_count(); ++f) {
    const auto& t = surface.triangles[f];
    if (t[0] == kNone || (peaks[t[0]] == peaks[t[1]] && peaks[t[1]] == peaks[t[2]])) continue;
    for (int i = 0; i < 3; ++i) {
      const std::int32_t h = halfedge(f, i);
      const std::int32_t v = t[i];
      const std::int32_t w = t[i == 2 ? 0 : i + 1];
      if (surface.twin[h] > h || peaks[v] == peaks[w] || !field.comparable(v, w)) continue;
      const float height = std::min(field.magnitude(v), field.magnitude(w));
      passes.push_back(std::uint64_t{~std::bit_cast<std::uint32_t>(height)} << 32 |
                       static_cast<std::uint32_t>(h));
    }
  }
  radix_sort(passes, 32, 64);  // half-edges already ascend

  // Passes are visited from the highest to the lowest, as a falling sea uncovers them. At each pass
  // two islands join, and the lower one becomes part of the higher one.
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
  for (const std::uint64_t pass : passes) {
    const auto h = static_cast<std::int32_t>(pass & 0xffffffff);
    std::int32_t high = summit(peaks[surface.origin(h)]);
    std::int32_t low = summit(peaks[surface.target(h)]);
    if (high == low) continue;
    const float height = std::bit_cast<float>(~static_cast<std::uint32_t>(pass >> 32));
    if (field.higher(low, high)) std::swap(low, high);
    result[low] = field.magnitude(low) - height;
    island[low] = high;
  }
  return result;
}

}  // namespace semigeo::kernels
