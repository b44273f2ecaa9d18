#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kernels/surface/connectivity.hpp"

namespace semigeo::kernels {

/// Says which splits of a loop are valid.
struct LoopSplitOptions {
  /// The least ratio of a split: the smallest distance of another vertex to the splitting plane,
  /// over the length of the splitting line.
  double min_ratio = 1e-6;
  /// Tells whether, where no plane separates the two sub-loops, a splitting line will do that
  /// neither of them crosses, seen along the average normal.
  bool allow_diagonals = true;
};

/// Covers a closed loop of points with triangles, by splitting it in two again and again until all
/// sub-loops have three edges. A split is a plane through two vertices along the average normal of
/// the loop. It is valid only if the two sub-loops lie on opposite sides of it, and among the valid
/// ones the one with the best ratio (see LoopSplitOptions) is taken. The cost is about n^2 for a
/// loop of n <= 128 edges, and n log n for halving longer ones as long as planes separate them. The
/// memory is kept from loop to loop; every thread needs a splitter of its own. Source: thesis 5.1.
///
/// Differs: where a (sub-)loop has no such plane, which is common on jagged loops, any diagonal
/// that stays inside the loop will do. Loops of more than 128 edges are split near the middle, by
/// the best of some planes instead of all.
class LoopSplitter {
 public:
  /// Tells whether vertices i and j of the loop must not be joined: they are an edge already.
  using Joined = std::function<bool(std::int32_t, std::int32_t)>;

  explicit LoopSplitter(const LoopSplitOptions& options = {}) : options_(options) {}

  /// Returns the triangles of `loop` (>= 3 points), as indices into it and running along it;
  /// nothing if some sub-loop has no valid split. Sub-loops are split along `normal`, about which
  /// the loop runs anticlockwise. If that is zero, each is split along its own average normal (its
  /// vector area), or, where that leads nowhere, all along that of the whole loop. The result is
  /// valid until the next call.
  std::span<const Triangle> split(std::span<const Eigen::Vector3d> loop, const Joined& joined,
                                  const Eigen::Vector3d& normal = Eigen::Vector3d::Zero());

  /// Splits each sub-loop along its own normal. Sub-loops without a valid split are put into
  /// `stuck`, as indices into the loop, and the others are split on.
  std::span<const Triangle> split_as_far_as_possible(std::span<const Eigen::Vector3d> loop,
                                                     const Joined& joined,
                                                     std::vector<std::vector<std::int32_t>>& stuck);

 private:
  struct Split {
    int i = -1;
    int j = -1;
    double score = 0;
    bool found() const { return i >= 0; }
  };

  bool split_all(std::span<const Eigen::Vector3d> loop, const Joined& joined,
                 const Eigen::Vector3d& normal, std::vector<std::vector<std::int32_t>>* stuck);
  Eigen::Vector3d own_normal(std::span<const Eigen::Vector3d> loop) const;
  bool project(std::span<const Eigen::Vector3d> loop, const Eigen::Vector3d& normal);
  Split best_split(const Joined& joined) const;
  Split best_of_all(const Joined& joined, bool planes) const;
  Split best_near_middle(const Joined& joined, bool planes) const;
  void consider(int i, int j, bool planes, double weight, const Joined& joined, Split& best) const;
  double plane_ratio(int i, int j, double at_least) const;
  double diagonal_ratio(int i, int j) const;
  double side(int i, int j, int k) const;
  bool inside_corner(int i, int j) const;
  bool crosses(int i, int j, int k) const;
  int size() const { return static_cast<int>(current_.size()); }
  int after(int k) const { return k + 1 == size() ? 0 : k + 1; }
  int before(int k) const { return k == 0 ? size() - 1 : k - 1; }

  LoopSplitOptions options_;
  std::vector<std::int32_t> pending_;       ///< Vertices of all sub-loops still to be split.
  std::vector<std::int32_t> sizes_;         ///< Number of vertices of each of those sub-loops.
  std::vector<std::int32_t> current_;       ///< The sub-loop that is being split.
  std::vector<Eigen::Vector2d> projected_;  ///< Its points, projected along its normal.
  std::vector<Triangle> triangles_;
};

}  // namespace semigeo::kernels
