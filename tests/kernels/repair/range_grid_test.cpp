#include "kernels/repair/range_grid.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

namespace semigeo::kernels {
namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();
const Eigen::Vector3d kEye(1, 2, 3);

/// A scene as a pinhole camera sees it.
struct View {
  RangeGrid grid;
  std::vector<Eigen::Vector3d> points;
  GridTriangles made;

  double area() const {
    double sum = 0;
    for (const auto& t : made.triangles) sum += normal(t).norm() / 2;
    return sum;
  }
  Eigen::Vector3d normal(const std::array<std::int32_t, 3>& t) const {
    return (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]);
  }
  /// Returns the length of all edges that only one triangle has.
  double rim() const {
    std::map<std::pair<std::int32_t, std::int32_t>, int> uses;
    for (const auto& t : made.triangles)
      for (int i = 0; i < 3; ++i) ++uses[std::minmax(t[i], t[(i + 1) % 3])];
    double sum = 0;
    for (const auto& [edge, count] : uses)
      if (count == 1) sum += (points[edge.first] - points[edge.second]).norm();
    return sum;
  }
  /// Returns the number of triangles that turn their front to the eye.
  std::int64_t facing() const {
    return std::ranges::count_if(
        made.triangles, [&](const auto& t) { return normal(t).dot(kEye - points[t[0]]) > 0; });
  }
};

/// Looks from the eye along -z. A ray (u, v, -1) meets the scene at depth_of(u, v).
template <typename Depth>
View look(int rows, int columns, double step, Depth depth_of, double depth_jump = kDepthJump,
          bool mirrored = false) {
  View view;
  view.grid = {.rows = rows, .columns = columns, .cells = {}, .eye = kEye};
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const double u = step * (c - (columns - 1) / 2.0) * (mirrored ? -1 : 1);
      const double v = step * (r - (rows - 1) / 2.0);
      const double depth = depth_of(u, v);
      const bool met = std::isfinite(depth);
      view.grid.cells.push_back(met ? static_cast<std::int32_t>(view.points.size()) : -1);
      if (met) view.points.emplace_back(kEye + depth * Eigen::Vector3d(u, v, -1));
    }
  view.made = triangulate_grid(view.grid, view.points, depth_jump);
  return view;
}

TEST(RangeGridTest, APlaneHasItsAreaAndItsRim) {
  for (const bool mirrored : {false, true}) {
    const View view = look(
        31, 41, 0.02, [](double, double) { return 5.0; }, kDepthJump, mirrored);
    EXPECT_EQ(view.made.triangles.size(), 2U * 30 * 40);
    EXPECT_EQ(view.made.jumps, 0);
    EXPECT_NEAR(view.area(), 30 * 40 * 0.1 * 0.1, 1e-9);
    EXPECT_NEAR(view.rim(), 2 * (30 + 40) * 0.1, 1e-9);
    EXPECT_EQ(view.facing(), 2 * 30 * 40);
  }
}

/// The far end of a tilted plane is three times as far as the near end, and seen at 70 degrees.
TEST(RangeGridTest, ATiltedPlaneKeepsItsFarEnd) {
  const double slope = std::tan(70 * std::numbers::pi / 180);  // depth = 2 + slope * lateral
  const View view = look(31, 41, 0.009, [&](double u, double) { return 2 / (1 - slope * u); });
  EXPECT_EQ(view.made.jumps, 0);
  EXPECT_GT(view.points[40].z() - kEye.z(), -6.0);
  EXPECT_LT(view.points[40].z() - kEye.z(), -3.9);
  const Eigen::Vector3d a = view.points[0], b = view.points[40];
  const Eigen::Vector3d c = view.points[view.points.size() - 1], d = view.points[30 * 41];
  EXPECT_NEAR(view.area(), (c - a).cross(d - b).norm() / 2, 1e-9);
  EXPECT_EQ(view.facing(), std::ssize(view.made.triangles));
}

TEST(RangeGridTest, ASphereIsMetUpToItsSilhouette) {
  constexpr double kDistance = 4;
  const auto depth_of = [](double u, double v) {
    const Eigen::Vector3d ray(u, v, 1);
    const double along = kDistance / ray.squaredNorm();
    const double inside = along * along - (kDistance * kDistance - 1) / ray.squaredNorm();
    return inside > 0 ? along - std::sqrt(inside) : kNothing;
  };
  // The cap that can be seen ends where rays touch. Nearly all of it is triangulated.
  const double cap = 2 * std::numbers::pi * (1 - 1 / kDistance);
  for (const int n : {100, 400}) {
    const View view = look(n, n, 0.6 / n, depth_of);
    EXPECT_LT(view.area(), cap);
    EXPECT_GT(view.area(), 0.75 * cap);
    EXPECT_GT(look(n, n, 0.6 / n, depth_of, 1e6).area(), (n == 100 ? 0.82 : 0.91) * cap);
    EXPECT_EQ(view.facing(), std::ssize(view.made.triangles));
  }
}

/// No triangle leads from one plane to the other, whose spacing is as large as it is farther away.
TEST(RangeGridTest, NoTriangleCrossesAStep) {
  for (const double far : {1.5, 3.0, 30.0}) {
    const View view = look(21, 40, 0.01, [&](double u, double) { return u < 0 ? 1.0 : far; });
    for (const auto& t : view.made.triangles)
      EXPECT_NEAR(view.points[t[0]].z(), view.points[t[1]].z(), 1e-9);
    EXPECT_EQ(view.made.triangles.size(), 2U * 2 * 20 * 19);
    EXPECT_EQ(view.made.jumps, 2 * 20);
    EXPECT_NEAR(view.area(), 20 * 19 * 1e-4 * (1 + far * far), 1e-9);
    EXPECT_NEAR(view.rim(), 2 * (20 + 19) * 0.01 * (1 + far), 1e-9);
  }
}

TEST(RangeGridTest, TheFactorSaysWhatIsAStep) {
  const auto depth_of = [](double u, double) { return u < 0 ? 1.0 : 1.05; };  // 5 spacings
  EXPECT_EQ(look(21, 40, 0.01, depth_of, 4).made.jumps, 2 * 20);
  EXPECT_EQ(look(21, 40, 0.01, depth_of, 6).made.jumps, 0);
}

/// Rows may be much farther apart than columns.
TEST(RangeGridTest, RowsAndColumnsHaveSpacingsOfTheirOwn) {
  RangeGrid grid{.rows = 5, .columns = 30, .cells = {}, .eye = {}};
  std::vector<Eigen::Vector3d> points;
  for (int r = 0; r < 5; ++r)
    for (int c = 0; c < 30; ++c) {
      grid.cells.push_back(static_cast<std::int32_t>(points.size()));
      points.emplace_back(c, 20.0 * r, c < 15 ? 0 : 10);
    }
  const GridTriangles made = triangulate_grid(grid, points);
  EXPECT_EQ(made.triangles.size(), 2U * 4 * 28);
  EXPECT_EQ(made.jumps, 2 * 4);
}

/// Columns to the right and rows upwards face the scanner.
TEST(RangeGridTest, WithoutAnEyeTheGridSaysWhichSideIsSeen) {
  const std::vector<Eigen::Vector3d> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.5}};
  const RangeGrid grid{.rows = 2, .columns = 2, .cells = {0, 1, 2, 3}, .eye = {}};
  EXPECT_EQ(triangulate_grid(grid, points).triangles,
            (std::vector<std::array<std::int32_t, 3>>{{0, 1, 2}, {1, 3, 2}}));
}

TEST(RangeGridTest, ThreePointsOfACellMakeOneTriangle) {
  const std::vector<Eigen::Vector3d> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  RangeGrid grid{.rows = 2, .columns = 2, .cells = {0, 1, 2, -1}, .eye = {}};
  const std::vector<std::array<std::int32_t, 3>> one = {{2, 0, 1}};
  EXPECT_EQ(triangulate_grid(grid, points).triangles, one);
  grid.cells = {0, -1, -1, 1};
  EXPECT_TRUE(triangulate_grid(grid, points).triangles.empty());
  grid = {.rows = 1, .columns = 3, .cells = {0, 1, 2}, .eye = {}};
  EXPECT_TRUE(triangulate_grid(grid, points).triangles.empty());
}

}  // namespace
}  // namespace semigeo::kernels
