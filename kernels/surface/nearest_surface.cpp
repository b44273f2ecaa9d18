#include "kernels/surface/nearest_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "kernels/surface/bounding_box.hpp"
#include "kernels/surface/z_order.hpp"

namespace semigeo::kernels {
namespace {

/// The number of faces of a leaf.
constexpr std::size_t kLeaf = 4;
/// The number of bits of a coordinate of the Z-order.
constexpr int kBits = 16;

Eigen::Vector3d nearest_on_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                   const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return a + t * along;
}

std::vector<std::int32_t> z_order(const Surface& surface) {
  const auto faces = static_cast<std::int32_t>(surface.face_count());
  if (faces == 0) return {};
  const Eigen::AlignedBox3f box = bounding_box(surface.points);
  const double size = box.sizes().maxCoeff();
  const double scale = size > 0 ? ((1 << kBits) - 1) / size : 0.0;
  std::vector<std::pair<std::uint64_t, std::int32_t>> keys(faces);
  for (std::int32_t f = 0; f < faces; ++f) {
    const auto& t = surface.triangles[f];
    std::uint64_t key = 0;
    for (int c = 0; c < 3; ++c) {
      const double middle = (static_cast<double>(surface.points[t[0]][c]) +
                             surface.points[t[1]][c] + surface.points[t[2]][c]) /
                            3;
      key |= spread_bits(static_cast<std::uint64_t>((middle - box.min()[c]) * scale)) << c;
    }
    keys[f] = {key, f};
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::int32_t> order(faces);
  for (std::int32_t f = 0; f < faces; ++f) order[f] = keys[f].second;
  return order;
}

/// Returns the squared distance of a point from a box, 0 inside, in double precision.
double squared_distance(const Eigen::AlignedBox3f& box, const Eigen::Vector3d& p) {
  return (box.min().cast<double>() - p)
      .cwiseMax(p - box.max().cast<double>())
      .cwiseMax(0.0)
      .squaredNorm();
}

}  // namespace

Eigen::Vector3d nearest_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                    const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double area2 = normal.squaredNorm();
  // If p lies above the inside of the triangle, the nearest point lies in its plane.
  if (area2 > 0) {
    const double u = (c - b).cross(p - b).dot(normal);
    const double v = (a - c).cross(p - c).dot(normal);
    const double w = (b - a).cross(p - a).dot(normal);
    if (u >= 0 && v >= 0 && w >= 0) return (u * a + v * b + w * c) / (u + v + w);
  }
  // Otherwise the nearest point lies on one of the sides.
  Eigen::Vector3d best = nearest_on_segment(p, a, b);
  for (const Eigen::Vector3d& q : {nearest_on_segment(p, b, c), nearest_on_segment(p, c, a)})
    if ((p - q).squaredNorm() < (p - best).squaredNorm()) best = q;
  return best;
}

NearestSurface::NearestSurface(const Surface& surface)
    : surface_(surface), faces_(z_order(surface)) {
  leaf_count_ = std::bit_ceil((faces_.size() + kLeaf - 1) / kLeaf);
  boxes_.resize(2 * leaf_count_);
  for (std::size_t k = 0; k < faces_.size(); ++k)
    for (const std::int32_t v : surface.triangles[faces_[k]])
      boxes_[leaf_count_ + k / kLeaf].extend(surface.points[v]);
  for (std::size_t k = leaf_count_; k-- > 1;) boxes_[k] = boxes_[2 * k].merged(boxes_[2 * k + 1]);
}

void NearestSurface::search_leaf(std::size_t leaf, const Eigen::Vector3d& p,
                                 NearestPoint& best) const {
  const std::size_t end = std::min((leaf + 1) * kLeaf, faces_.size());
  for (std::size_t k = leaf * kLeaf; k < end; ++k) {
    const auto& t = surface_.triangles[faces_[k]];
    const Eigen::Vector3d q = nearest_on_triangle(p, surface_.points[t[0]].cast<double>(),
                                                  surface_.points[t[1]].cast<double>(),
                                                  surface_.points[t[2]].cast<double>());
    const double distance = (p - q).norm();
    if (distance < best.distance || (best.face == kNone && distance == best.distance))
      best = {faces_[k], distance, q};
  }
}

NearestPoint NearestSurface::nearest(const Eigen::Vector3d& p, double limit) const {
  NearestPoint best;
  best.distance = limit;
  if (faces_.empty()) return {};
  struct Pending {
    std::size_t box;
    double squared_distance;
  };
  // The search goes depth first and takes the nearer child first, so that at most one box of each
  // level waits.
  std::array<Pending, 64> pending;
  int count = 0;
  pending[count++] = {1, squared_distance(boxes_[1], p)};
  while (count > 0) {
    const Pending next = pending[--count];
    const double reach2 = best.distance * best.distance;
    if (next.squared_distance > reach2 || (best.face != kNone && next.squared_distance == reach2))
      continue;
    if (next.box >= leaf_count_) {
      search_leaf(next.box - leaf_count_, p, best);
      continue;
    }
    Pending near{2 * next.box, squared_distance(boxes_[2 * next.box], p)};
    Pending far{2 * next.box + 1, squared_distance(boxes_[2 * next.box + 1], p)};
    if (far.squared_distance < near.squared_distance) std::swap(near, far);
    pending[count++] = far;
    pending[count++] = near;
  }
  return best.face == kNone ? NearestPoint{} : best;
}

void DistanceSummary::add(const DistanceSummary& other) {
  maximum = std::max(maximum, other.maximum);
  sum += other.sum;
  count += other.count;
}

DistanceSummary distances(const NearestSurface& surface, std::span<const Eigen::Vector3f> points) {
  DistanceSummary summary;
  for (const auto& p : points) {
    const double distance = surface.nearest(p.cast<double>()).distance;
    summary.maximum = std::max(summary.maximum, distance);
    summary.sum += distance;
    ++summary.count;
  }
  return summary;
}

}  // namespace semigeo::kernels
