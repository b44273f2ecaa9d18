#include "io/library/packed_normal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace semigeo::io {
namespace {

TEST(PackedNormal, IsNearlyTheSameAndStaysTheSame) {
  double worst = 0;
  for (int i = 0; i < 200; ++i)
    for (int j = 0; j <= 100; ++j) {
      const double azimuth = 2 * M_PI * i / 200;
      const double height = M_PI * j / 100;
      const Eigen::Vector3d n(std::sin(height) * std::cos(azimuth),
                              std::sin(height) * std::sin(azimuth), std::cos(height));
      const Eigen::Vector3f once = unpack_normal(pack_normal(n.cast<float>()));
      EXPECT_NEAR(once.norm(), 1, 1e-6);
      worst = std::max(worst, (once.cast<double>() - n).norm());
      EXPECT_EQ(unpack_normal(pack_normal(once)), once);
    }
  EXPECT_LT(worst, 0.004 * M_PI / 180);
}

TEST(PackedNormal, AxesAreExact) {
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0F, 1.0F}) {
      const Eigen::Vector3f n = sign * Eigen::Vector3f::Unit(axis);
      EXPECT_EQ(unpack_normal(pack_normal(n)), n);
      EXPECT_EQ(unpack_normal(pack_normal(5 * n)), n);
    }
}

TEST(PackedNormal, EveryPatternIsADirection) {
  for (int x = 0; x <= 65535; x += 257)
    for (int y = 0; y <= 65535; y += 257)
      EXPECT_NEAR(
          unpack_normal({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)}).norm(), 1,
          1e-6);
}

TEST(PackedNormal, NothingBecomesTheZAxis) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Eigen::Vector3f& n : {Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(nan, 0, 1)})
    EXPECT_EQ(unpack_normal(pack_normal(n)), Eigen::Vector3f(0, 0, 1));
}

}  // namespace
}  // namespace semigeo::io
