#include "kernels/features/extrema.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

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
  for (const std::int32_t u : neighbours(surface, v))
    for (const std::int32_t w : neighbours(surface, u))
      if (field.outdoes(w, v)) {  // which is rarer than a short path
        const double rest = radius - length(v, u);
        if (!(rest > 0)) break;
        if (length(u, w) <= rest) return true;
      }
  return false;
}

Eigen::Vector3d point_of(std::span<const Eigen::Vector4f> points, std::int32_t v) {
  return points[v].head<3>().cast<double>();
}

/// Returns the point nearest to `place` on the faces round v.
Summit nearest_on_ring(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
                       std::int32_t v, const Eigen::Vector3d& place) {
  const Eigen::Vector3d centre = point_of(points, v);
  Summit best{{v, v, v}, {1, 0, 0}};
  double nearest2 = (place - centre).squaredNorm();
  for (const std::int32_t h : outgoing(surface, v)) {
    const std::int32_t a = surface.target(h);
    const std::int32_t b = surface.origin(prev(h));
    const Eigen::Vector3d at_a_point = point_of(points, a);
    const Eigen::Vector3d at_b_point = point_of(points, b);
    const Eigen::Vector3d on_face = nearest_on_triangle(place, centre, at_a_point, at_b_point);
    const Eigen::Vector3d normal = (at_a_point - centre).cross(at_b_point - centre);
    const double distance2 = (on_face - place).squaredNorm();
    if (!(distance2 < nearest2 && normal.squaredNorm() > 0)) continue;
    nearest2 = distance2;
    const auto share = [&](const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
      const double area = (p - on_face).cross(q - on_face).dot(normal);
      return static_cast<float>(std::clamp(area / normal.squaredNorm(), 0.0, 1.0));
    };
    const float at_a = share(at_b_point, centre);
    const float at_b = std::min(share(centre, at_a_point), 1 - at_a);
    best = {{v, a, b}, {1 - at_a - at_b, at_a, at_b}};
  }
  return best;
}

/// The tangent plane at a vertex, with the mean length of the edges there as the unit of length.
struct TangentPlane {
  Eigen::Vector3d centre;
  Eigen::Vector3d x;
  Eigen::Vector3d y;
  double unit = 0;  ///< It is 0 if there is no plane.

  /// Returns the coordinates of a point near by, at its own distance from the centre.
  Eigen::Vector2d coordinates(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d d = (point - centre) / unit;
    const Eigen::Vector2d flat(d.dot(x), d.dot(y));
    const double length = flat.norm();
    return length > 0 ? Eigen::Vector2d(flat * (d.norm() / length)) : flat;
  }
  Eigen::Vector3d point(const Eigen::Vector2d& at) const {
    return centre + unit * (at.x() * x + at.y() * y);
  }
};

TangentPlane tangent_plane(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
                           std::int32_t v) {
  TangentPlane plane;
  plane.centre = point_of(points, v);
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double length = 0;
  int faces = 0;
  for (const std::int32_t h : outgoing(surface, v)) {
    const Eigen::Vector3d spoke = point_of(points, surface.target(h)) - plane.centre;
    normal += spoke.cross(point_of(points, surface.origin(prev(h))) - plane.centre);
    length += spoke.norm();
    ++faces;
  }
  if (!(normal.norm() > 0)) return plane;
  plane.unit = length / faces;
  plane.x = normal.normalized().unitOrthogonal();
  plane.y = normal.normalized().cross(plane.x);
  return plane;
}

/// Returns v, its neighbours and theirs; fewer if there are very many.
std::vector<std::int32_t> two_rings(const Connectivity& surface, std::int32_t v) {
  constexpr std::size_t kMost = 64;
  std::vector<std::int32_t> rings = {v};
  const auto add_neighbours = [&](std::int32_t of) {
    for (const std::int32_t w : neighbours(surface, of))
      if (rings.size() < kMost && std::ranges::find(rings, w) == rings.end()) rings.push_back(w);
  };
  add_neighbours(v);
  const std::size_t one_ring = rings.size();
  for (std::size_t i = 1; i < one_ring; ++i) add_neighbours(rings[i]);
  return rings;
}

/// A quadratic polynomial that is fitted to samples in a plane by least squares. Samples count less
/// the farther they are from the origin.
class Quadratic {
 public:
  void add(const Eigen::Vector2d& at, double value) {
    constexpr double kWidth = 0.8;  // sigma of the weights
    Eigen::Vector<double, 6> basis;
    basis << 1, at.x(), at.y(), at.x() * at.x() / 2, at.x() * at.y(), at.y() * at.y() / 2;
    const double weight = std::exp(-at.squaredNorm() / (2 * kWidth * kWidth));
    squares_ += weight * basis * basis.transpose();
    right_ += weight * value * basis;
    ++count_;
  }

  /// Returns where the maximum is, but along each principal axis not farther from the origin than
  /// about an edge; nothing if there is none, or if there are too few samples to tell.
  std::optional<Eigen::Vector2d> maximum() const {
    constexpr int kLeastSamples = 9;
    constexpr double kFarthest = 0.8;
    constexpr double kLeastBend = 0.05;  // of a ridge along its crest, as a share of that across
    constexpr double kFlat = 1e-5;       // bend per edge^2 that may be rounding, in values
    if (count_ < kLeastSamples) return std::nullopt;
    const Eigen::Vector<double, 6> c = squares_.ldlt().solve(right_);
    Eigen::Matrix2d hessian;
    hessian << c[3], c[4], c[4], c[5];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(hessian);
    const double steepest = -axes.eigenvalues()[0];
    if (!(steepest > kFlat * std::abs(c[0]))) return std::nullopt;
    Eigen::Vector2d place = Eigen::Vector2d::Zero();
    for (int i = 0; i < 2; ++i) {
      const Eigen::Vector2d axis = axes.eigenvectors().col(i);
      const double bend = std::max(-axes.eigenvalues()[i], kLeastBend * steepest);
      place += std::clamp(axis.dot(c.segment<2>(1)) / bend, -kFarthest, kFarthest) * axis;
    }
    return place;
  }

 private:
  Eigen::Matrix<double, 6, 6> squares_ = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Vector<double, 6> right_ = Eigen::Vector<double, 6>::Zero();
  int count_ = 0;
};

}  // namespace

std::vector<float> heights_of(std::span<const float> values, std::span<const float> completeness,
                              float min_completeness, float flat) {
  std::vector<float> heights(values.size());
  for (std::size_t v = 0; v < values.size(); ++v)
    heights[v] = !(completeness[v] >= min_completeness) ? std::numeric_limits<float>::quiet_NaN()
                 : std::abs(values[v]) > flat           ? values[v]
                                                        : 0.0f;
  return heights;
}

bool is_maximum(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
                const CurvatureField& field, std::int32_t v, double radius, GeodesicBall& ball) {
  if (!field.comparable(v, v)) return false;
  for (const std::int32_t w : neighbours(surface, v))
    if (field.outdoes(w, v)) return false;
  if (!(radius > 0)) return true;
  if (outdone_two_edges_away(surface, points, field, v, radius)) return false;
  bool highest = true;
  ball.surround(surface, points, v, radius, [&](std::int32_t w) {
    highest = !field.outdoes(w, v);
    return highest;
  });
  if (highest) return true;
  highest = true;  // unless it is outdone along the surface as well
  ball.grow(surface, points, v, radius, [&](std::int32_t w, double) {
    highest = !field.outdoes(w, v);
    return highest;
  });
  return highest;
}

Summit summit(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
              const CurvatureField& field, std::int32_t v) {
  float least = field.magnitude(v);
  for (const std::int32_t w : neighbours(surface, v))
    if (field.comparable(v, w)) least = std::min(least, field.magnitude(w));
  double weights = field.magnitude(v) - least;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();  // sum of positions relative to v
  for (const std::int32_t w : neighbours(surface, v)) {
    if (!field.comparable(v, w)) continue;
    weights += field.magnitude(w) - least;
    sum += static_cast<double>(field.magnitude(w) - least) *
           (point_of(points, w) - point_of(points, v));
  }
  if (!(weights > 0)) return {{v, v, v}, {1, 0, 0}};
  return nearest_on_ring(surface, points, v, point_of(points, v) + sum / weights);
}

Summit fitted_summit(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
                     const CurvatureField& field, std::span<const float> values, std::int32_t v) {
  const TangentPlane plane = tangent_plane(surface, points, v);
  const float sign = values[v] > 0 ? 1.0f : -1.0f;
  Quadratic fit;
  for (const std::int32_t w : two_rings(surface, v))
    if (field.takes_part(w))
      fit.add(plane.coordinates(point_of(points, w)), static_cast<double>(sign * values[w]));
  const std::optional<Eigen::Vector2d> place = fit.maximum();
  if (!place || !(plane.unit > 0)) return summit(surface, points, field, v);
  return nearest_on_ring(surface, points, v, plane.point(*place));
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
