#include "kernels/recognition/surface_samples.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "kernels/recognition/overlap.hpp"
#include "kernels/surface/bounding_box.hpp"
#include "kernels/surface/radix_sort.hpp"
#include "kernels/surface/z_order.hpp"

namespace semigeo::kernels {
namespace {

using Eigen::Vector3f;

using Triangles = std::span<const Triangle>;

double area_of(std::span<const Vector3f> points, const Triangle& triangle) {
  const Eigen::Vector3d p = points[triangle[0]].cast<double>();
  const Eigen::Vector3d u = points[triangle[1]].cast<double>() - p;
  const Eigen::Vector3d v = points[triangle[2]].cast<double>() - p;
  return 0.5 * u.cross(v).norm();
}

/// Returns the faces in their order along a Z-order curve. Equal steps of area along the curve are
/// spread evenly in space.
std::vector<std::int32_t> along_curve(std::span<const Vector3f> points, Triangles triangles) {
  const Eigen::AlignedBox3f box = bounding_box(points);
  const float cell = std::max(box.sizes().maxCoeff(), 1e-30F) / 1023;
  std::vector<std::uint64_t> keys;  // place along the curve and face, in one number
  keys.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles) {
    const Vector3f place = ((points[a] + points[b] + points[c]) / 3 - box.min()) / cell;
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis)
      key |= spread_bits(static_cast<std::uint64_t>(place[axis])) << axis;
    keys.push_back(key << 32 | keys.size());
  }
  radix_sort(keys, 32, 62);
  std::vector<std::int32_t> order;
  order.reserve(keys.size());
  for (const std::uint64_t key : keys) order.push_back(static_cast<std::int32_t>(key));
  return order;
}

/// Returns the pairs of vertices that only one triangle joins.
std::vector<std::array<std::int32_t, 2>> boundary_edges(Triangles triangles) {
  std::vector<std::uint64_t> edges;
  edges.reserve(3 * triangles.size());
  std::int32_t vertices = 0;
  for (const auto& t : triangles)
    for (int i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(t[i], t[(i + 1) % 3]);
      edges.push_back(std::uint64_t{static_cast<std::uint32_t>(low)} << 32 |
                      static_cast<std::uint32_t>(high));
      vertices = std::max(vertices, high + 1);
    }
  const auto bits = static_cast<int>(std::bit_width(static_cast<std::uint32_t>(vertices)));
  radix_sort(edges, 0, bits);
  radix_sort(edges, 32, 32 + bits);
  std::vector<std::array<std::int32_t, 2>> single;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i + 1;
    while (j < edges.size() && edges[j] == edges[i]) ++j;
    if (j == i + 1)
      single.push_back({static_cast<std::int32_t>(edges[i] >> 32),
                        static_cast<std::int32_t>(edges[i] & 0xffffffff)});
    i = j;
  }
  return single;
}

/// Returns point k of a sequence that is spread evenly over the unit square: the fractions of k
/// times two irrational numbers (a Kronecker sequence with the plastic number).
Eigen::Vector2f spread_over_square(std::int64_t k) {
  constexpr double kPlastic = 1.32471795724474602596;
  const auto fraction = [](double x) { return static_cast<float>(x - std::floor(x)); };
  const auto n = static_cast<double>(k);
  return {fraction(n / kPlastic), fraction(n / (kPlastic * kPlastic))};
}

/// Returns the place of each of 0, 1, ..., count - 1 in an order whose beginnings are all spread
/// evenly. It is the order of the reversed bits.
std::vector<std::int64_t> evenly_begun(std::int64_t count) {
  const auto bits = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(count - 1)));
  std::vector<std::int64_t> place(count);
  std::int64_t next = 0;
  for (std::int64_t i = 0; i < std::int64_t{1} << bits; ++i) {
    std::int64_t reversed = 0;
    for (int bit = 0; bit < bits; ++bit) reversed |= ((i >> bit) & 1) << (bits - 1 - bit);
    if (reversed < count) place[reversed] = next++;
  }
  return place;
}

}  // namespace

SurfaceSamples sample_surface(std::span<const Vector3f> points, Triangles triangles,
                              std::span<const Vector3f> normals, std::int64_t count) {
  SurfaceSamples samples;
  if (triangles.empty() || count <= 0) return samples;
  const std::vector<std::int32_t> order = along_curve(points, triangles);
  std::vector<double> areas;
  areas.reserve(order.size());
  double area = 0;
  for (const std::int32_t face : order)
    area += areas.emplace_back(area_of(points, triangles[face]));
  if (!(area > 0)) return samples;
  samples.spacing = static_cast<float>(std::sqrt(area / static_cast<double>(count)));
  samples.points.resize(count);
  samples.normals.resize(count);
  const std::vector<std::int64_t> place = evenly_begun(count);
  std::size_t face = 0;
  double area_until = areas.front();
  for (std::int64_t k = 0; k < count; ++k) {
    const double at = (static_cast<double>(k) + 0.5) / static_cast<double>(count) * area;
    while (area_until <= at && face + 1 < order.size()) area_until += areas[++face];
    const auto& [a, b, c] = triangles[order[face]];
    Eigen::Vector2f uv = spread_over_square(k);
    if (uv.sum() > 1) uv = Eigen::Vector2f::Ones() - uv;
    const auto mixed = [&](const Vector3f& p, const Vector3f& q, const Vector3f& r) -> Vector3f {
      return (1 - uv.sum()) * p + uv.x() * q + uv.y() * r;
    };
    samples.points[place[k]] = mixed(points[a], points[b], points[c]);
    samples.normals[place[k]] = mixed(normals[a], normals[b], normals[c]).stableNormalized();
  }
  return samples;
}

void mark_rim(std::span<const Vector3f> points, Triangles triangles, SurfaceSamples& samples) {
  samples.rim.clear();
  const auto edges = boundary_edges(triangles);
  if (edges.empty() || samples.points.empty()) return;
  SurfaceSamples boundary;
  for (const auto& [a, b] : edges) {
    const float length = (points[b] - points[a]).norm();
    const int steps =
        static_cast<int>(std::fmin(std::fmax(std::ceil(length / samples.spacing), 1), 1000));
    for (int i = 0; i < steps; ++i)
      boundary.points.push_back(points[a] + (static_cast<float>(i) + 0.5F) /
                                                static_cast<float>(steps) *
                                                (points[b] - points[a]));
  }
  const SampleTree tree(boundary);
  samples.rim.reserve(samples.points.size());
  for (const Vector3f& p : samples.points)
    samples.rim.push_back(tree.nearest(p, 2 * samples.spacing) >= 0 ? 1 : 0);
}

}  // namespace semigeo::kernels
