#include "kernels/repair/loop_split.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace semigeo::kernels {
namespace {

/// The length up to which all splits of a loop are tried.
constexpr int kExhaustive = 128;
/// The number of vertices from which splits of longer loops are tried.
constexpr int kStarts = 24;
/// A split of a longer loop must leave at least 1 / kLeastShare of it on each side.
constexpr int kLeastShare = 8;
double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double distance_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                           const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - a - t * along).norm();
}

}  // namespace

std::span<const Triangle> LoopSplitter::split(std::span<const Eigen::Vector3d> loop,
                                              const Joined& joined, const Eigen::Vector3d& normal) {
  if (!normal.isZero(0)) {
    split_all(loop, joined, normal, nullptr);
  } else if (!split_all(loop, joined, normal, nullptr)) {
    current_.resize(loop.size());
    std::iota(current_.begin(), current_.end(), 0);
    split_all(loop, joined, own_normal(loop), nullptr);
  }
  return triangles_;
}

std::span<const Triangle> LoopSplitter::split_as_far_as_possible(
    std::span<const Eigen::Vector3d> loop, const Joined& joined,
    std::vector<std::vector<std::int32_t>>& stuck) {
  stuck.clear();
  split_all(loop, joined, Eigen::Vector3d::Zero(), &stuck);
  return triangles_;
}

/// Splits all sub-loops along `normal`, or, if that is zero, each along its own normal.
bool LoopSplitter::split_all(std::span<const Eigen::Vector3d> loop, const Joined& joined,
                             const Eigen::Vector3d& normal,
                             std::vector<std::vector<std::int32_t>>* stuck) {
  triangles_.clear();
  pending_.resize(loop.size());
  std::iota(pending_.begin(), pending_.end(), 0);
  sizes_.assign(1, static_cast<std::int32_t>(loop.size()));
  while (!sizes_.empty()) {
    const std::int32_t n = sizes_.back();
    current_.assign(pending_.end() - n, pending_.end());
    pending_.resize(pending_.size() - n);
    sizes_.pop_back();
    const bool is_part = n < static_cast<std::int32_t>(loop.size());
    if (n == 3 && (is_part || !own_normal(loop).isZero(0))) {
      triangles_.push_back({current_[0], current_[1], current_[2]});
      continue;
    }
    const bool is_seen = project(loop, normal.isZero(0) ? own_normal(loop) : normal);
    const Split best = is_seen && n > 3 ? best_split(joined) : Split{};
    if (!best.found() && stuck != nullptr) {
      stuck->push_back(current_);
      continue;
    }
    if (!best.found()) {
      triangles_.clear();
      return false;
    }
    pending_.insert(pending_.end(), current_.begin() + best.i, current_.begin() + best.j + 1);
    sizes_.push_back(best.j - best.i + 1);
    pending_.insert(pending_.end(), current_.begin() + best.j, current_.end());
    pending_.insert(pending_.end(), current_.begin(), current_.begin() + best.i + 1);
    sizes_.push_back(n - (best.j - best.i) + 1);
  }
  return true;
}

/// Returns twice the vector area of the current sub-loop, or zero if it is nothing but rounding.
Eigen::Vector3d LoopSplitter::own_normal(std::span<const Eigen::Vector3d> loop) const {
  const Eigen::Vector3d& anchor = loop[current_[0]];
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  double extent = 0;
  for (int k = 1; k + 1 < size(); ++k) {
    const Eigen::Vector3d a = loop[current_[k]] - anchor;
    const Eigen::Vector3d b = loop[current_[k + 1]] - anchor;
    area += a.cross(b);
    extent = std::max({extent, a.squaredNorm(), b.squaredNorm()});
  }
  if (!(area.norm() > 1e-9 * extent)) area.setZero();
  return area;
}

/// Projects the current sub-loop along `normal`. Returns false if that is zero.
bool LoopSplitter::project(std::span<const Eigen::Vector3d> loop, const Eigen::Vector3d& normal) {
  const double length = normal.norm();
  if (!(length > 0)) return false;
  const Eigen::Vector3d along = normal / length;
  const Eigen::Vector3d u = along.unitOrthogonal();
  const Eigen::Vector3d v = along.cross(u);
  const Eigen::Vector3d& anchor = loop[current_[0]];
  projected_.resize(current_.size());
  for (int k = 0; k < size(); ++k) {
    const Eigen::Vector3d p = loop[current_[k]] - anchor;
    projected_[k] = {p.dot(u), p.dot(v)};
  }
  return true;
}

LoopSplitter::Split LoopSplitter::best_split(const Joined& joined) const {
  for (const bool planes : {true, false}) {
    if (!planes && !options_.allow_diagonals) return {};
    const Split best =
        size() > kExhaustive ? best_near_middle(joined, planes) : best_of_all(joined, planes);
    if (best.found()) return best;
  }
  return {};
}

LoopSplitter::Split LoopSplitter::best_of_all(const Joined& joined, bool planes) const {
  Split best;
  const int n = size();
  for (int i = 0; i + 2 < n; ++i)
    for (int j = i + 2; j < n; ++j)
      if (i != 0 || j != n - 1) consider(i, j, planes, 1, joined, best);
  return best;
}

LoopSplitter::Split LoopSplitter::best_near_middle(const Joined& joined, bool planes) const {
  Split best;
  const int n = size();
  const int least = n / kLeastShare;
  for (int s = 0; s < kStarts; ++s) {
    const int start = static_cast<int>(static_cast<std::int64_t>(s) * n / kStarts);
    for (int steps = least; steps <= n - least; ++steps) {
      const int other = (start + steps) % n;
      const double share = static_cast<double>(std::min(steps, n - steps)) / n;
      consider(std::min(start, other), std::max(start, other), planes, share, joined, best);
    }
  }
  return best;
}

void LoopSplitter::consider(int i, int j, bool planes, double weight, const Joined& joined,
                            Split& best) const {
  const double at_least = std::max(best.score / weight, options_.min_ratio);
  const double ratio = planes ? plane_ratio(i, j, at_least) : diagonal_ratio(i, j);
  if (ratio > at_least && !joined(current_[i], current_[j])) best = {i, j, ratio * weight};
}

/// Returns twice the area of (i, j, k), positive if k lies left of the line from i to j.
double LoopSplitter::side(int i, int j, int k) const {
  return cross(projected_[j] - projected_[i], projected_[k] - projected_[i]);
}

/// Returns the ratio of the split by the plane through i < j. If the split is invalid, or its ratio
/// is not above `at_least`, the result is any number up to `at_least`.
double LoopSplitter::plane_ratio(int i, int j, double at_least) const {
  const double length2 = (projected_[j] - projected_[i]).squaredNorm();
  if (!(length2 > 0)) return 0;
  // The neighbours of i and j decide in nearly all cases.
  double least = std::min(
      {-side(i, j, i + 1), -side(i, j, j - 1), side(i, j, after(j)), side(i, j, before(i))});
  const double enough = at_least * length2;
  if (!(least > enough)) return 0;
  const int n = size();
  for (int k = i + 2; k < j - 1; ++k) {
    least = std::min(least, -side(i, j, k));
    if (!(least > enough)) return 0;
  }
  for (int k = j + 2; k < n + i - 1; ++k) {
    least = std::min(least, side(i, j, k < n ? k : k - n));
    if (!(least > enough)) return 0;
  }
  return least / length2;
}

/// Tells whether the line from i to j starts into the inside of the loop.
bool LoopSplitter::inside_corner(int i, int j) const {
  const int a = before(i);
  const int b = after(i);
  if (side(a, i, b) > 0) return side(i, b, j) > 0 && side(i, j, a) > 0;
  return !(side(i, a, j) >= 0 && side(i, j, b) >= 0);
}

/// Tells whether the line i - j meets the edge k - after(k), which must have neither as its end.
bool LoopSplitter::crosses(int i, int j, int k) const {
  const int l = after(k);
  const double a = side(i, j, k);
  const double b = side(i, j, l);
  if ((a > 0 && b > 0) || (a < 0 && b < 0)) return false;
  const double c = side(k, l, i);
  const double d = side(k, l, j);
  return !((c > 0 && d > 0) || (c < 0 && d < 0));
}

/// Returns the ratio of the split along the diagonal i < j, with distances to that line instead of
/// a plane. The result is 0 if the diagonal leaves the inside of the loop.
double LoopSplitter::diagonal_ratio(int i, int j) const {
  const double length = (projected_[j] - projected_[i]).norm();
  if (!(length > 0) || !inside_corner(i, j) || !inside_corner(j, i)) return 0;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < size(); ++k) {
    if (k == i || k == j) continue;
    const int l = after(k);
    if (l != i && l != j && crosses(i, j, k)) return 0;
    least = std::min(least, distance_to_segment(projected_[k], projected_[i], projected_[j]));
  }
  return least / length;
}

}  // namespace semigeo::kernels
