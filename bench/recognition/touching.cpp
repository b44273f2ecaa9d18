#include "bench/recognition/touching.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "bench/support/mesh_changes.hpp"
#include "kernels/surface/bounding_box.hpp"

namespace semigeo::recognition {
namespace {

using kernels::TriangleMesh;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// The gap between two objects, as a share of the larger one. It keeps rounding from letting them
/// cross.
constexpr double kGap = 1e-6;
constexpr int kAttempts = 100;

/// Returns a mesh as it is seen along a direction: x and y across it, z against it.
TriangleMesh seen_along(const TriangleMesh& mesh, const Eigen::Matrix3d& frame) {
  TriangleMesh result = mesh;
  for (Eigen::Vector3d& p : result.points) p = frame * p;
  return result;
}

/// Finds triangles by their places across the direction.
class Grid {
 public:
  explicit Grid(const TriangleMesh& mesh) : mesh_(mesh), box_(kernels::bounding_box(mesh.points)) {
    side_ = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(mesh.triangles.size()))));
    cells_.resize(static_cast<std::size_t>(side_) * side_);
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
      Eigen::AlignedBox3d box;
      for (const std::int32_t v : mesh.triangles[f]) box.extend(mesh.points[v]);
      for (int y = cell(box.min(), 1); y <= cell(box.max(), 1); ++y)
        for (int x = cell(box.min(), 0); x <= cell(box.max(), 0); ++x)
          cells_[static_cast<std::size_t>(y) * side_ + x].push_back(static_cast<std::int32_t>(f));
    }
  }

  /// Calls `visit` with the height of each triangle that lies above or below a point.
  template <typename Visit>
  void heights(const Eigen::Vector3d& p, const Visit& visit) const {
    for (int axis = 0; axis < 2; ++axis)
      if (p[axis] < box_.min()[axis] || p[axis] > box_.max()[axis]) return;
    for (const std::int32_t f : cells_[static_cast<std::size_t>(cell(p, 1)) * side_ + cell(p, 0)]) {
      const auto& t = mesh_.triangles[f];
      const Eigen::Vector3d &a = mesh_.points[t[0]], &b = mesh_.points[t[1]],
                            &c = mesh_.points[t[2]];
      const double all = cross(a, b, c), at_a = cross(p, b, c), at_b = cross(a, p, c),
                   at_c = cross(a, b, p);
      if (all == 0 || at_a / all < 0 || at_b / all < 0 || at_c / all < 0) continue;
      visit((at_a * a.z() + at_b * b.z() + at_c * c.z()) / all);
    }
  }

 private:
  int cell(const Eigen::Vector3d& p, int axis) const {
    const double extent = box_.sizes()[axis];
    const double share = extent > 0 ? (p[axis] - box_.min()[axis]) / extent : 0.0;
    return std::clamp(static_cast<int>(share * side_), 0, side_ - 1);
  }
  /// Returns twice the signed area across the direction.
  static double cross(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                      const Eigen::Vector3d& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
  }

  const TriangleMesh& mesh_;
  Eigen::AlignedBox3d box_;
  int side_ = 1;
  std::vector<std::vector<std::int32_t>> cells_;
};

/// Returns the smallest distance downwards from a vertex of the upper mesh to a face of the lower
/// one, or from a face of the upper mesh to a vertex of the lower one.
double way_down(const TriangleMesh& upper, const TriangleMesh& lower) {
  double way = kInfinity;
  const Grid below(lower);
  for (const Eigen::Vector3d& p : upper.points)
    below.heights(p, [&](double z) { way = std::min(way, p.z() - z); });
  const Grid above(upper);
  for (const Eigen::Vector3d& p : lower.points)
    above.heights(p, [&](double z) { way = std::min(way, z - p.z()); });
  return way;
}

}  // namespace

double way_to_contact(const TriangleMesh& moving, const TriangleMesh& still,
                      const Eigen::Vector3d& direction) {
  const Eigen::Matrix3d frame =
      Eigen::Quaterniond::FromTwoVectors(direction, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return way_down(seen_along(moving, frame), seen_along(still, frame));
}

Eigen::Vector3d touching_shift(const TriangleMesh& moving, const TriangleMesh& still,
                               bench::Random& random) {
  const Eigen::AlignedBox3d moving_box = kernels::bounding_box(moving.points);
  const Eigen::AlignedBox3d still_box = kernels::bounding_box(still.points);
  const double smaller = std::min(moving_box.diagonal().norm(), still_box.diagonal().norm());
  const double larger = std::max(moving_box.diagonal().norm(), still_box.diagonal().norm());
  std::uniform_real_distribution<double> off(0.0, 0.25);
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const Eigen::Vector3d direction = bench::normal_vector(random).normalized();
    const Eigen::Vector3d aside =
        bench::normal_vector(random).cross(direction).normalized() * off(random) * smaller;
    const Eigen::Vector3d shift = still_box.center() - moving_box.center() + aside;
    TriangleMesh placed = moving;
    for (Eigen::Vector3d& p : placed.points) p += shift;
    const double way = way_to_contact(placed, still, direction);
    if (way < kInfinity) return shift - (way - kGap * larger) * direction;
  }
  throw std::runtime_error("objects pass each other by on every side");
}

}  // namespace semigeo::recognition
