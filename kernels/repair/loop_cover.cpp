#include "kernels/repair/loop_cover.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <utility>

namespace semigeo::kernels {
namespace {

/// The weight of bending. An edge of length l that is bent by 90 degrees costs as much as an area
/// of l^2 / 4.
constexpr double kBending = 0.25;
/// The cosine between the normals of two neighbours below which they fold back on each other.
constexpr double kFold = -0.85;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Computes the least cost of all stretches of a loop, from the shortest to the longest.
class Cover {
 public:
  Cover(std::span<const Eigen::Vector3d> loop, std::span<const Eigen::Vector3d> normals)
      : loop_(loop), size_(static_cast<std::int32_t>(loop.size())) {
    stretches_.resize(loop.size() * loop.size());
    for (std::int32_t i = 0; i + 1 < size_; ++i) at(i, i + 1) = {0, -1, normals[i], 0};
    closing_normal_ = normals[size_ - 1];
  }

  void solve(const std::function<bool(std::int32_t, std::int32_t)>& joined) {
    for (std::int32_t width = 2; width < size_; ++width)
      for (std::int32_t i = 0; i + width < size_; ++i) {
        const bool closing = width == size_ - 1;
        if (closing || !joined(i, i + width)) find_tip(i, i + width, closing);
      }
  }

  LoopCover result() const {
    LoopCover cover;
    if (!(at(0, size_ - 1).cost < kInfinity)) return cover;
    std::vector<std::pair<std::int32_t, std::int32_t>> pending{{0, size_ - 1}};
    while (!pending.empty()) {
      const auto [i, k] = pending.back();
      pending.pop_back();
      const Stretch& stretch = at(i, k);
      if (stretch.tip < 0) continue;
      cover.triangles.push_back({i, stretch.tip, k});
      cover.area += stretch.area;
      for (const Stretch* side : {&at(i, stretch.tip), &at(stretch.tip, k)})
        if (side->tip >= 0 && side->normal.dot(stretch.normal) < kFold)
          cover.folded_area += std::min(side->area, stretch.area);
      pending.emplace_back(stretch.tip, k);
      pending.emplace_back(i, stretch.tip);
    }
    return cover;
  }

 private:
  /// Describes the cover of a part of the loop: from one vertex to a later one, and straight back.
  struct Stretch {
    double cost = kInfinity;
    std::int32_t tip = -1;  ///< Third corner of the triangle at the straight line; -1: no triangle.
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< Normal of that triangle.
    double area = 0;                                   ///< Area of that triangle.
  };

  Stretch& at(std::int32_t i, std::int32_t k) {
    return stretches_[static_cast<std::size_t>(i) * size_ + k];
  }
  const Stretch& at(std::int32_t i, std::int32_t k) const {
    return stretches_[static_cast<std::size_t>(i) * size_ + k];
  }

  double bending(const Eigen::Vector3d& a, const Eigen::Vector3d& b, std::int32_t i,
                 std::int32_t k) const {
    return kBending * (1 - a.dot(b)) * (loop_[k] - loop_[i]).squaredNorm();
  }

  void find_tip(std::int32_t i, std::int32_t k, bool closing) {
    Stretch best;
    for (std::int32_t m = i + 1; m < k; ++m) {
      const Stretch& left = at(i, m);
      const Stretch& right = at(m, k);
      double cost = left.cost + right.cost;
      if (!(cost < best.cost)) continue;
      const Eigen::Vector3d across = (loop_[m] - loop_[i]).cross(loop_[k] - loop_[i]);
      const double length = across.norm();
      const Eigen::Vector3d normal = length > 0 ? Eigen::Vector3d(across / length) : left.normal;
      cost +=
          0.5 * length + bending(normal, left.normal, i, m) + bending(normal, right.normal, m, k);
      if (closing) cost += bending(normal, closing_normal_, i, k);
      if (cost < best.cost) best = {cost, m, normal, 0.5 * length};
    }
    at(i, k) = best;
  }

  std::span<const Eigen::Vector3d> loop_;
  std::int32_t size_;
  std::vector<Stretch> stretches_;  ///< (n, n) Only the upper triangle is used.
  Eigen::Vector3d closing_normal_;  ///< Normal across the edge from the last to the first vertex.
};

}  // namespace

LoopCover cover_loop(std::span<const Eigen::Vector3d> loop,
                     std::span<const Eigen::Vector3d> normals,
                     const std::function<bool(std::int32_t, std::int32_t)>& joined) {
  Cover cover(loop, normals);
  cover.solve(joined);
  return cover.result();
}

}  // namespace semigeo::kernels
