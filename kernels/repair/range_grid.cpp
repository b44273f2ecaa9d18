#include "kernels/repair/range_grid.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace semigeo::kernels {
namespace {

/// Returns the median, or infinity if there are no values. Values change places.
double median_of(std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::infinity();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

class GridTriangulator {
 public:
  GridTriangulator(const RangeGrid& grid, std::span<const Eigen::Vector3d> points,
                   double depth_jump)
      : grid_(grid), points_(points) {
    const double columns = spacing_to(0, 1);
    const double rows = spacing_to(1, 0);
    longest_ = {0, depth_jump * columns, depth_jump * std::hypot(rows, columns), depth_jump * rows};
  }

  GridTriangles triangulate() && {
    for (std::int64_t r = 0; r + 1 < grid_.rows; ++r)
      for (std::int64_t c = 0; c + 1 < grid_.columns; ++c) add_cell(r, c);
    if (towards_eye_ < 0)
      for (auto& triangle : result_.triangles) std::swap(triangle[1], triangle[2]);
    return std::move(result_);
  }

 private:
  std::int32_t at(std::int64_t row, std::int64_t column) const {
    return grid_.cells[row * grid_.columns + column];
  }
  double length(std::int32_t a, std::int32_t b) const { return (points_[a] - points_[b]).norm(); }
  /// Returns the factor by which the spacing at a point exceeds that at distance 1 from the eye.
  double depth(std::int32_t a) const { return grid_.eye ? (points_[a] - *grid_.eye).norm() : 1; }
  /// Returns how long the edge is in units of the depth of its nearer end.
  double relative_length(std::int32_t a, std::int32_t b) const {
    const double nearer = std::min(depth(a), depth(b));
    return nearer > 0 ? length(a, b) / nearer : std::numeric_limits<double>::infinity();
  }

  /// Returns the median relative distance of rays that are so many rows and columns apart.
  double spacing_to(std::int64_t row, std::int64_t column) const {
    std::vector<double> lengths;
    for (std::int64_t r = 0; r + row < grid_.rows; ++r)
      for (std::int64_t c = 0; c + column < grid_.columns; ++c) {
        const std::int32_t a = at(r, c), b = at(r + row, c + column);
        if (a >= 0 && b >= 0) lengths.push_back(relative_length(a, b));
      }
    return median_of(lengths);
  }

  void add_cell(std::int64_t r, std::int64_t c) {
    corner_ = {at(r, c), at(r, c + 1), at(r + 1, c + 1), at(r + 1, c)};
    const auto missing = std::ranges::count(corner_, -1);
    if (missing > 1) return;
    if (missing == 1) {
      const auto gap = static_cast<int>(std::ranges::find(corner_, -1) - corner_.begin());
      add((gap + 1) % 4, (gap + 2) % 4, (gap + 3) % 4);
    } else if (length(corner_[0], corner_[2]) <= length(corner_[1], corner_[3])) {
      add(0, 1, 2);
      add(0, 2, 3);
    } else {
      add(0, 1, 3);
      add(1, 2, 3);
    }
  }

  /// Returns whether the edge between two corners of the cell is short enough.
  bool is_short(int i, int j) const {
    // Corners go round: i ^ j is 1 along a row, 3 along a column and 2 across.
    return relative_length(corner_[i], corner_[j]) <= longest_[i ^ j];
  }

  void add(int i, int j, int k) {
    if (!is_short(i, j) || !is_short(j, k) || !is_short(k, i)) {
      ++result_.jumps;
      return;
    }
    const std::array triangle = {corner_[i], corner_[j], corner_[k]};
    result_.triangles.push_back(triangle);
    if (!grid_.eye) return;
    const Eigen::Vector3d& p = points_[triangle[0]];
    const Eigen::Vector3d normal = (points_[triangle[1]] - p).cross(points_[triangle[2]] - p);
    towards_eye_ += normal.dot((*grid_.eye - p).normalized());
  }

  const RangeGrid& grid_;
  std::span<const Eigen::Vector3d> points_;
  std::array<double, 4> longest_ = {};       // relative length of an edge, by i ^ j of its corners
  std::array<std::int32_t, 4> corner_ = {};  // points of the cell, in order round it
  double towards_eye_ = 0;                   // area seen from the eye, minus that seen from behind
  GridTriangles result_;
};

}  // namespace

GridTriangles triangulate_grid(const RangeGrid& grid, std::span<const Eigen::Vector3d> points,
                               double depth_jump) {
  return GridTriangulator(grid, points, depth_jump).triangulate();
}

}  // namespace semigeo::kernels
