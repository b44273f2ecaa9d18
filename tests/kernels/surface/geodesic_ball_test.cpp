#include "kernels/surface/geodesic_ball.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <set>

#include "tests/support/prepared_surface.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::kernels {
namespace {

std::map<std::int32_t, double> ball_of(const PreparedSurface& s, std::int32_t centre, double radius,
                                       GeodesicBall& ball) {
  std::map<std::int32_t, double> found;
  double last = 0;
  ball.grow(s.surface, s.points, centre, radius, [&](std::int32_t v, double distance) {
    EXPECT_GE(distance, 0.95 * last);
    last = std::max(last, distance);
    EXPECT_TRUE(found.emplace(v, distance).second) << "twice";
    return true;
  });
  return found;
}

TEST(GeodesicBallTest, OnAPlaneItIsADisc) {
  TriangleMesh mesh = shapes::plane(2, 24);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> shift(-0.02, 0.02);
  for (auto& p : mesh.points) p += Eigen::Vector3d(shift(random), shift(random), 0);
  const PreparedSurface s(mesh, false);
  GeodesicBall ball;
  for (const std::int32_t centre : {0, 40, 312, 500}) {
    const auto found = ball_of(s, centre, 0.5, ball);
    double sum = 0;
    for (std::int32_t v = 0; v < s.surface.vertex_count(); ++v) {
      const double distance = (s.points[v] - s.points[centre]).head<3>().norm();
      if (!found.contains(v)) {
        EXPECT_GT(distance, 0.48);
        continue;
      }
      EXPECT_GE(found.at(v), distance - 1e-6);
      EXPECT_LE(found.at(v), 1.08 * distance + 1e-6);
      if (v != centre) sum += found.at(v) / distance - 1;
    }
    EXPECT_LT(sum / static_cast<double>(found.size()), 0.015);
  }
}

TEST(GeodesicBallTest, OnASphereItFollowsGreatCircles) {
  const PreparedSurface s(shapes::icosphere(4), false);
  GeodesicBall ball;
  const auto found = ball_of(s, 77, 1.2, ball);
  for (const auto& [v, distance] : found) {
    const double exact =
        std::acos(std::clamp<double>(s.points[v].head<3>().dot(s.points[77].head<3>()), -1, 1));
    EXPECT_NEAR(distance, exact, 0.01 * exact + 1e-4);
  }
  // Area of a cap of 1.2 radians, in vertices.
  EXPECT_NEAR(static_cast<double>(found.size()), 2562 * (1 - std::cos(1.2)) / 2, 30);
}

TEST(GeodesicBallTest, ThinSheetsAreFarApartOnTheirTwoSides) {
  TriangleMesh box = shapes::cube(1, 10);
  for (auto& p : box.points) p.z() *= 0.01;
  const PreparedSurface s(box, false);
  std::int32_t centre = 0;
  for (std::int32_t v = 0; v < s.surface.vertex_count(); ++v)
    if (s.points[v].head<2>().norm() < 1e-6f && s.points[v].z() > 0) centre = v;
  GeodesicBall ball;
  for (const auto& [v, distance] : ball_of(s, centre, 0.4, ball)) EXPECT_GT(s.points[v].z(), 0);
}

TEST(GeodesicBallTest, TheRingCountsHoweverFar) {
  const PreparedSurface s(shapes::icosphere(1), false);
  GeodesicBall ball;
  EXPECT_EQ(ball_of(s, 20, 0.0, ball).size(), 7);
  EXPECT_EQ(ball_of(s, 0, 1e-6, ball).size(), 6);
}

TEST(GeodesicBallTest, StopsWhenTold) {
  const PreparedSurface s(shapes::icosphere(3), false);
  GeodesicBall ball;
  int visited = 0;
  ball.grow(s.surface, s.points, 5, 10, [&](std::int32_t, double) { return ++visited < 17; });
  EXPECT_EQ(visited, 17);
}

TEST(GeodesicBallTest, SurroundVisitsAllThatGrowVisitsAndNoVertexTwice) {
  TriangleMesh mesh = shapes::torus(1, 0.4, 60, 24, 0.8);
  shapes::add_noise(mesh, 0.01, 3);
  const PreparedSurface s(std::move(mesh));
  GeodesicBall ball;
  for (std::int32_t centre = 0; centre < s.surface.vertex_count(); centre += 7)
    for (const double radius : {0.0, 0.05, 0.3, 0.7}) {
      std::set<std::int32_t> around;
      ball.surround(s.surface, s.points, centre, radius, [&](std::int32_t v) {
        EXPECT_TRUE(around.insert(v).second);
        return true;
      });
      std::size_t within = 0;
      ball.grow(s.surface, s.points, centre, radius, [&](std::int32_t v, double) {
        EXPECT_TRUE(around.contains(v)) << centre << ' ' << radius << ' ' << v;
        ++within;
        return true;
      });
      EXPECT_LE(around.size(), 2 * within + 20);
    }
}

}  // namespace
}  // namespace semigeo::kernels
