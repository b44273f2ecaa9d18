#include "kernels/repair/loop_split.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "kernels/repair/loop_cover.hpp"

namespace semigeo::kernels {
namespace {

using Loop = std::vector<Eigen::Vector3d>;
using Triangles = std::vector<std::array<std::int32_t, 3>>;

bool never(std::int32_t /*a*/, std::int32_t /*b*/) {
  return false;
}

Triangles split(const Loop& loop, const LoopSplitOptions& options = {},
                const LoopSplitter::Joined& joined = never) {
  LoopSplitter splitter(options);
  const auto triangles = splitter.split(loop, joined);
  return {triangles.begin(), triangles.end()};
}

/// Every edge of the loop once, in its direction, and all others twice, once each way.
void expect_covers(const Triangles& triangles, int n) {
  ASSERT_EQ(triangles.size(), n - 2u);
  std::map<std::pair<int, int>, int> directed;
  for (const auto& t : triangles)
    for (int i = 0; i < 3; ++i) ++directed[{t[i], t[(i + 1) % 3]}];
  for (int k = 0; k < n; ++k) EXPECT_EQ(directed.count({k, (k + 1) % n}), 1u);
  for (const auto& [edge, count] : directed) {
    EXPECT_EQ(count, 1);
    const bool on_loop = edge.second == (edge.first + 1) % n;
    EXPECT_EQ(directed.count({edge.second, edge.first}), on_loop ? 0u : 1u);
  }
}

double area(const Loop& loop, const Triangles& triangles) {
  double sum = 0;
  for (const auto& t : triangles)
    sum += 0.5 * (loop[t[1]] - loop[t[0]]).cross(loop[t[2]] - loop[t[0]]).norm();
  return sum;
}

/// `at(phi)` for n angles.
Loop round(int n, const std::function<Eigen::Vector3d(double)>& at) {
  Loop loop;
  for (int k = 0; k < n; ++k) loop.push_back(at(2 * std::numbers::pi * k / n));
  return loop;
}

Loop circle(int n) {
  return round(n, [](double a) { return Eigen::Vector3d(std::cos(a), std::sin(a), 0); });
}

Loop star(int n, double depth) {
  Loop loop = circle(2 * n);
  for (int k = 1; k < 2 * n; k += 2) loop[k] *= depth;
  return loop;
}

TEST(LoopSplitTest, ATriangleIsItself) {
  EXPECT_EQ(split(circle(3)), (Triangles{{0, 1, 2}}));
}

TEST(LoopSplitTest, AQuadIsSplitWhereTheRatioIsBest) {
  // A kite: its short diagonal leaves the other corners 2 and 1 away, its long one 0.5.
  const Loop kite{{-0.5, 0, 0}, {0, -1, 0}, {0.5, 0, 0}, {0, 2, 0}};
  const Triangles triangles = split(kite);
  expect_covers(triangles, 4);
  for (const auto& t : triangles) EXPECT_EQ(std::count(t.begin(), t.end(), 0), 1);
  for (const auto& t : triangles) EXPECT_EQ(std::count(t.begin(), t.end(), 2), 1);
}

TEST(LoopSplitTest, CirclesOfAnySizeAreCoveredOnce) {
  for (const int n : {4, 5, 17, 128, 129, 300}) {
    const Loop loop = circle(n);
    const Triangles triangles = split(loop);
    expect_covers(triangles, n);
    EXPECT_NEAR(area(loop, triangles), 0.5 * n * std::sin(2 * std::numbers::pi / n), 1e-9);
  }
}

TEST(LoopSplitTest, ALongLoopTakesNoLongTime) {
  const int n = 5000;
  const Loop loop = round(n, [](double a) {
    const double r = 1 + 0.2 * std::sin(7 * a) + 0.001 * std::sin(1237 * a);
    return Eigen::Vector3d(r * std::cos(a), r * std::sin(a), 0.1 * std::cos(3 * a));
  });
  expect_covers(split(loop), n);
}

TEST(LoopSplitTest, SaddleShapedLoopsAreSplitByPlanesAlone) {
  const Loop loop = round(60, [](double a) {
    return Eigen::Vector3d(std::cos(a), std::sin(a), 0.7 * std::cos(2 * a));
  });
  const Triangles triangles = split(loop, {.allow_diagonals = false});
  expect_covers(triangles, 60);
  for (const auto& t : triangles)
    EXPECT_GT((loop[t[1]] - loop[t[0]]).cross(loop[t[2]] - loop[t[0]]).z(), 0);
}

TEST(LoopSplitTest, AJaggedLoopNeedsDiagonals) {
  // A comb with crooked teeth: the plane along any splitting line cuts into other teeth.
  Loop comb{{0, 0, 0}, {10, 0, 0}};
  for (int k = 4; k >= 0; --k) {
    comb.push_back({2.0 * k + 1.9, 1, 0});
    comb.push_back({2.0 * k + 3.0, 4, 0});
    comb.push_back({2.0 * k + 0.1, 1, 0});
  }
  const auto n = static_cast<int>(comb.size());
  EXPECT_TRUE(split(comb, {.allow_diagonals = false}).empty());
  const Triangles triangles = split(comb);
  expect_covers(triangles, n);
  double shoelace = 0;
  for (int k = 0; k < n; ++k) shoelace += 0.5 * comb[k].cross(comb[(k + 1) % n]).z();
  EXPECT_NEAR(area(comb, triangles), shoelace, 1e-12);
  expect_covers(split(star(9, 0.3)), 18);
}

TEST(LoopSplitTest, NothingThatIsJoinedIsJoinedAgain) {
  const Loop loop = star(4, 0.7);
  const auto joined = [](std::int32_t a, std::int32_t b) { return a % 2 == 1 && b % 2 == 1; };
  const Triangles triangles = split(loop, {}, joined);
  // The notches 1, 3, 5, 7 must not be joined, and between two tips nothing is inside.
  EXPECT_TRUE(triangles.empty());
  EXPECT_TRUE(split(circle(4), {}, [](auto, auto) { return true; }).empty());
}

TEST(LoopSplitTest, AFigureOfEightHasNoValidSplit) {
  const Loop bow{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_TRUE(split(bow).empty());
  const std::vector<Eigen::Vector3d> normals(4, Eigen::Vector3d::UnitZ());
  const LoopCover cover = cover_loop(bow, normals, never);
  EXPECT_GT(cover.folded_area, kMostFolded * cover.area);
}

TEST(LoopSplitTest, LoopsWithoutAreaHaveNoValidSplit) {
  EXPECT_TRUE(split({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).empty());
  EXPECT_TRUE(split({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}).empty());
}

TEST(LoopCoverTest, CoversALoopThatCrossesItselfSeenFromAnySide) {
  // The seam of a tennis ball has no vector area; seen from anywhere it crosses itself.
  const int n = 48;
  const double b = 0.4;
  Loop loop = round(n, [&](double t) {
    return Eigen::Vector3d((1 - b) * std::cos(t) + b * std::cos(3 * t),
                           (1 - b) * std::sin(t) - b * std::sin(3 * t),
                           2 * std::sqrt((1 - b) * b) * std::sin(2 * t));
  });
  std::vector<Eigen::Vector3d> normals;
  for (int k = 0; k < n; ++k) normals.push_back((loop[k] + loop[(k + 1) % n]).normalized());
  const Triangles triangles = cover_loop(loop, normals, never).triangles;
  expect_covers(triangles, n);
}

TEST(LoopCoverTest, APlanarLoopIsCoveredOnce) {
  const Loop loop = star(7, 0.5);
  const std::vector<Eigen::Vector3d> normals(14, Eigen::Vector3d::UnitZ());
  const Triangles triangles = cover_loop(loop, normals, never).triangles;
  expect_covers(triangles, 14);
  double shoelace = 0;
  for (int k = 0; k < 14; ++k) shoelace += 0.5 * loop[k].cross(loop[(k + 1) % 14]).z();
  EXPECT_NEAR(area(loop, triangles), shoelace, 1e-12);
}

}  // namespace
}  // namespace semigeo::kernels
