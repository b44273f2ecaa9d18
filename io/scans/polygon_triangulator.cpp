#include "io/scans/polygon_triangulator.hpp"

#include <Eigen/Geometry>

namespace semigeo::io {
namespace {

constexpr std::int64_t kStepsPerCorner = 4096;

/// Returns twice the vector area. Corners are taken relative to the first one, which keeps the
/// digits of small polygons far from the coordinate origin.
Eigen::Vector3d newell_normal(std::span<const Eigen::Vector3d> corners) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    normal += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
  return normal;
}

}  // namespace

std::span<const std::array<std::int32_t, 3>> PolygonTriangulator::triangulate(
    std::span<const Eigen::Vector3d> corners) {
  triangles_.clear();
  if (corners.size() == 3) {
    triangles_.push_back({0, 1, 2});
  } else if (corners.size() == 4) {
    cut_quad(corners);
  } else {
    clip_ears(corners, newell_normal(corners));
  }
  return triangles_;
}

void PolygonTriangulator::cut_quad(std::span<const Eigen::Vector3d> corners) {
  const Eigen::Vector3d diagonal02 = corners[2] - corners[0];
  const Eigen::Vector3d diagonal13 = corners[3] - corners[1];
  const Eigen::Vector3d normal = diagonal02.cross(diagonal13);
  const auto keeps_side = [&](int a, int b, int c) {
    return (corners[b] - corners[a]).cross(corners[c] - corners[a]).dot(normal) > 0;
  };
  const bool fits02 = keeps_side(0, 1, 2) && keeps_side(0, 2, 3);
  const bool fits13 = keeps_side(1, 2, 3) && keeps_side(1, 3, 0);
  const bool shorter13 = diagonal13.squaredNorm() < diagonal02.squaredNorm();
  if (fits13 && (!fits02 || shorter13)) {
    triangles_ = {{0, 1, 3}, {1, 2, 3}};
  } else {
    triangles_ = {{0, 1, 2}, {0, 2, 3}};
  }
}

double PolygonTriangulator::area(std::int32_t a, std::int32_t b, std::int32_t c) const {
  const Eigen::Vector2d ab = flat_[b] - flat_[a];
  const Eigen::Vector2d ac = flat_[c] - flat_[a];
  return ab.x() * ac.y() - ab.y() * ac.x();
}

void PolygonTriangulator::find_reflex() {
  const auto n = static_cast<std::int32_t>(flat_.size());
  reflex_.clear();
  is_reflex_.assign(n, 0);
  for (std::int32_t i = 0; i < n; ++i) {
    if (area(previous_[i], i, next_[i]) > 0) continue;
    is_reflex_[i] = 1;
    reflex_.push_back(i);
  }
}

bool PolygonTriangulator::is_spike(std::int32_t corner) const {
  const Eigen::Vector2d& a = flat_[previous_[corner]];
  const Eigen::Vector2d& c = flat_[next_[corner]];
  return flat_[corner] == a || flat_[corner] == c || a == c;
}

bool PolygonTriangulator::is_ear(std::int32_t corner) {
  const std::int32_t a = previous_[corner];
  const std::int32_t c = next_[corner];
  if (is_spike(corner)) return true;
  if (!(area(a, corner, c) > 0)) return false;
  for (const std::int32_t p : reflex_) {
    --steps_left_;
    if (!is_reflex_[p] || p == a || p == c) continue;
    // At a bridge to a hole another corner lies exactly on a corner of the ear. It does not matter.
    if (flat_[p] == flat_[a] || flat_[p] == flat_[corner] || flat_[p] == flat_[c]) continue;
    if (area(a, corner, p) >= 0 && area(corner, c, p) >= 0 && area(c, a, p) >= 0) return false;
  }
  return true;
}

void PolygonTriangulator::clip_ears(std::span<const Eigen::Vector3d> corners,
                                    const Eigen::Vector3d& normal) {
  // A projection along the largest component of the normal keeps every orientation.
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const Eigen::Index u = (axis + (normal[axis] < 0 ? 2 : 1)) % 3;
  const Eigen::Index v = 3 - axis - u;
  const auto n = static_cast<std::int32_t>(corners.size());
  flat_.resize(n);
  next_.resize(n);
  previous_.resize(n);
  for (std::int32_t i = 0; i < n; ++i) {
    const Eigen::Vector3d p = corners[i] - corners[0];
    flat_[i] = {p[u], p[v]};
    next_[i] = i + 1 < n ? i + 1 : 0;
    previous_[i] = i > 0 ? i - 1 : n - 1;
  }
  find_reflex();

  steps_left_ = kStepsPerCorner * n;
  std::int32_t left = n;
  std::int32_t corner = 0;
  for (std::int32_t failures = 0; left > 3 && failures < left && steps_left_ > 0; --steps_left_) {
    const std::int32_t before = previous_[corner];
    const std::int32_t after = next_[corner];
    if (!is_ear(corner)) {
      ++failures;
      corner = after;
      continue;
    }
    failures = 0;
    triangles_.push_back({before, corner, after});
    is_reflex_[corner] = 0;
    next_[before] = after;
    previous_[after] = before;
    --left;
    for (const std::int32_t p : {before, after})
      if (is_reflex_[p] && area(previous_[p], p, next_[p]) > 0) is_reflex_[p] = 0;
    // The search goes on one corner after `after`, which avoids fans of slivers. A spike, where the
    // polygon touches itself, is cut off first, or ears beyond it might be found.
    corner = is_spike(before) ? before : is_spike(after) ? after : next_[after];
  }
  for (std::int32_t p = next_[corner]; next_[p] != corner; p = next_[p])
    triangles_.push_back({corner, p, next_[p]});
}

}  // namespace semigeo::io
