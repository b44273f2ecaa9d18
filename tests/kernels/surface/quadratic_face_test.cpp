#include "kernels/surface/quadratic_face.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace semigeo::kernels {
namespace {

using Eigen::Vector3f;

// On a circle the lifted middle of a chord misses the arc by fourth order, the chord by second.
TEST(QuadraticFaceTest, EdgeFollowsACircle) {
  double previous = 0;
  for (const float angle : {0.4f, 0.2f, 0.1f}) {
    const Vector3f p(std::cos(angle), -std::sin(angle), 0), q(std::cos(angle), std::sin(angle), 0);
    const Eigen::Vector3f bulge = edge_bulge(p, q, p, q);
    const double error = std::abs(((p + q) / 2 + bulge.head<3>() / 4).norm() - 1);
    EXPECT_LT(error, 0.4 * std::pow(angle, 4));
    if (previous > 0 && error > 1e-7) EXPECT_LT(error, previous / 10);
    previous = error;
  }
}

TEST(QuadraticFaceTest, BulgeIsTheSameSeenFromBothEnds) {
  const Vector3f p(0, 0, 0), q(1, 0.2f, 0.1f);
  const Vector3f m = Vector3f(0.1f, 0, 1).normalized(), n = Vector3f(-0.3f, 0.1f, 1).normalized();
  EXPECT_TRUE(edge_bulge(p, q, m, n).isApprox(edge_bulge(q, p, n, m)));
}

TEST(QuadraticFaceTest, FlatNormalsGiveAFlatEdge) {
  const Vector3f up(0, 0, 1);
  EXPECT_TRUE(edge_bulge({0, 0, 0}, {1, 2, 0}, up, up).isZero(0));
  EXPECT_TRUE(edge_bulge({0, 0, 0}, {1, 2, 3}, Vector3f::Zero(), Vector3f::Zero()).isZero(0));
}

}  // namespace
}  // namespace semigeo::kernels
