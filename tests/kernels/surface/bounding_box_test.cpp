#include "kernels/surface/bounding_box.hpp"

#include <gtest/gtest.h>

#include <array>
#include <type_traits>
#include <vector>

namespace semigeo::kernels {
namespace {

TEST(BoundingBoxTest, HoldsAllPointsAndNoMore) {
  const std::array<Eigen::Vector3f, 3> points = {
      Eigen::Vector3f(1, -2, 3), Eigen::Vector3f(-1, 5, 3), Eigen::Vector3f(0, 0, -0.5F)};
  const Eigen::AlignedBox3f box = bounding_box(points);
  EXPECT_EQ(box.min(), Eigen::Vector3f(-1, -2, -0.5F));
  EXPECT_EQ(box.max(), Eigen::Vector3f(1, 5, 3));
}

TEST(BoundingBoxTest, KeepsThePrecisionOfThePoints) {
  const std::vector<Eigen::Vector3d> points = {{0.1, 0.2, 0.3}};
  static_assert(std::is_same_v<decltype(bounding_box(points)), Eigen::AlignedBox3d>);
  EXPECT_EQ(bounding_box(points).min(), points[0]);
  EXPECT_EQ(bounding_box(points).max(), points[0]);
}

TEST(BoundingBoxTest, IsEmptyWithoutPoints) {
  EXPECT_TRUE(bounding_box(std::vector<Eigen::Vector3f>()).isEmpty());
}

}  // namespace
}  // namespace semigeo::kernels
