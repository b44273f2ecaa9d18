#include "io/scans/polygon_triangulator.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace semigeo::io {
namespace {

using Polygon = std::vector<Eigen::Vector3d>;

/// Sum of the triangles' areas along the normal, and the smallest of them.
struct Areas {
  double sum = 0;
  double least = 1e300;
};

Areas areas(const Polygon& corners, const Eigen::Vector3d& normal) {
  PolygonTriangulator triangulator;
  const auto triangles = triangulator.triangulate(corners);
  EXPECT_EQ(triangles.size(), corners.size() - 2);
  Areas result;
  for (const auto& [a, b, c] : triangles) {
    const double area =
        (corners.at(b) - corners[a]).cross(corners.at(c) - corners[a]).dot(normal) / 2;
    result.sum += area;
    result.least = std::min(result.least, area);
  }
  return result;
}

/// A star of `points` points: radii 1 and 0.3 in turn.
Polygon star(int points) {
  Polygon corners;
  for (int i = 0; i < 2 * points; ++i) {
    const double angle = std::numbers::pi * i / points;
    const double radius = i % 2 == 0 ? 1 : 0.3;
    corners.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  return corners;
}

double area_of_star(int points) {
  return points * 0.3 * std::sin(std::numbers::pi / points);
}

TEST(PolygonTriangulator, CutsConvexQuadsAlongTheShorterDiagonal) {
  PolygonTriangulator triangulator;
  const Polygon flat = {{0, 0, 0}, {3, 1, 0}, {4, 3, 0}, {1, 2, 0}};  // 0-2: 5, 1-3: sqrt 5
  const auto triangles = triangulator.triangulate(flat);
  EXPECT_EQ(triangles[0], (std::array<std::int32_t, 3>{0, 1, 3}));
  EXPECT_EQ(triangles[1], (std::array<std::int32_t, 3>{1, 2, 3}));
}

TEST(PolygonTriangulator, CutsConcaveQuadsInsideFromEveryStart) {
  Polygon dart = {{0, 2, 0}, {-1, 0, 0}, {0, 0.5, 0}, {1, 0, 0}};
  for (int start = 0; start < 4; ++start) {
    const Areas found = areas(dart, Eigen::Vector3d::UnitZ());
    EXPECT_NEAR(found.sum, 1.5, 1e-12);
    EXPECT_GT(found.least, 0);
    std::rotate(dart.begin(), dart.begin() + 1, dart.end());
  }
}

TEST(PolygonTriangulator, KeepsOrientationInEveryPlane) {
  for (int plane = 0; plane < 6; ++plane) {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    normal[plane % 3] = plane < 3 ? 1 : -1;
    normal += Eigen::Vector3d(0.1, 0.2, 0.3);
    normal.normalize();
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal);
    for (const double far : {0.0, 1e6}) {
      Polygon corners = star(7);
      for (Eigen::Vector3d& p : corners) p = turn * p + Eigen::Vector3d(far, -far, far);
      const Areas found = areas(corners, normal);
      EXPECT_NEAR(found.sum, area_of_star(7), 1e-6);
      EXPECT_GT(found.least, 0);
    }
  }
}

TEST(PolygonTriangulator, CutsHolesJoinedByABridge) {
  // A square of side 4 with a hole of side 2; the bridge runs to the hole and back.
  Polygon corners = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                     {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
  for (std::size_t start = 0; start < corners.size(); ++start) {
    const Areas found = areas(corners, Eigen::Vector3d::UnitZ());
    EXPECT_NEAR(found.sum, 12, 1e-12);
    EXPECT_GE(found.least, 0);
    std::rotate(corners.begin(), corners.begin() + 1, corners.end());
  }
}

TEST(PolygonTriangulator, CutsPolygonsThatTouchThemselves) {
  // Two triangles that meet in a corner, which is met twice.
  Polygon corners = {{0, 0, 0}, {1, -1, 0}, {1, 1, 0}, {0, 0, 0}, {-1, 1, 0}, {-1, -1, 0}};
  for (std::size_t start = 0; start < corners.size(); ++start) {
    const Areas found = areas(corners, Eigen::Vector3d::UnitZ());
    EXPECT_NEAR(found.sum, 2, 1e-12);
    EXPECT_GE(found.least, 0);
    std::rotate(corners.begin(), corners.begin() + 1, corners.end());
  }
}

TEST(PolygonTriangulator, CutsLargePolygons) {
  const Areas found = areas(star(1000), Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(found.sum, area_of_star(1000), 1e-9);
  EXPECT_GT(found.least, 0);
}

TEST(PolygonTriangulator, GivesSomeTrianglesForDegenerateOnes) {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  EXPECT_EQ(areas(Polygon(4, Eigen::Vector3d(1, 2, 3)), z).sum, 0);
  EXPECT_EQ(areas(Polygon(9, Eigen::Vector3d(1, 2, 3)), z).sum, 0);
  Polygon line;
  for (int i = 0; i < 20; ++i) line.emplace_back(i * i % 7, 0, 0);
  EXPECT_EQ(areas(line, z).sum, 0);
  Polygon zigzag;  // crosses itself at every step, the worst case for the search of ears
  for (int i = 0; i < 65'535; ++i) zigzag.emplace_back(i % 256, (i * 7919) % 65'521, 0);
  areas(zigzag, z);
}

}  // namespace
}  // namespace semigeo::io
