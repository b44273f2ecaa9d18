#include "jobs/picture/camera.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <limits>
#include <span>
#include <vector>

namespace semigeo::jobs {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;

TEST(CameraTest, EveryViewIsARotation) {
  for (std::size_t view = 0; view < kViewNames.size(); ++view)
    for (const UpAxis up : {UpAxis::kY, UpAxis::kZ}) {
      const Matrix3f axes = axes_of(static_cast<View>(view), up);
      EXPECT_TRUE((axes * axes.transpose()).isIdentity(1e-5f)) << kViewNames[view];
      EXPECT_NEAR(axes.determinant(), 1, 1e-5f) << kViewNames[view];
    }
}

TEST(CameraTest, ViewsShowTheAxesWhereTheyShould) {
  EXPECT_TRUE(axes_of(View::kFront, UpAxis::kY).isIdentity());
  // From the back x points to the left, from the right z does.
  EXPECT_TRUE((axes_of(View::kBack, UpAxis::kY) * Vector3f::UnitX()).isApprox(-Vector3f::UnitX()));
  EXPECT_TRUE((axes_of(View::kRight, UpAxis::kY) * Vector3f::UnitZ()).isApprox(-Vector3f::UnitX()));
  EXPECT_TRUE((axes_of(View::kTop, UpAxis::kY) * Vector3f::UnitY()).isApprox(Vector3f::UnitZ()));
  // Upwards is z, if the scan says so, and x stays at the right of the front.
  EXPECT_TRUE((axes_of(View::kFront, UpAxis::kZ) * Vector3f::UnitZ()).isApprox(Vector3f::UnitY()));
  EXPECT_TRUE((axes_of(View::kFront, UpAxis::kZ) * Vector3f::UnitX()).isApprox(Vector3f::UnitX()));
  const Vector3f up = axes_of(View::kIso, UpAxis::kZ) * Vector3f::UnitZ();
  EXPECT_NEAR(up.x(), 0, 1e-6f);
  EXPECT_GT(up.y(), 0.5f);
}

TEST(CameraTest, ShowsAllPointsAndFillsOneSide) {
  const std::vector<float> first = {10, 0, 0, 14, 0, 0};
  const std::vector<float> second = {12, -0.5f, 3, std::numeric_limits<float>::quiet_NaN(), 0, 0};
  const std::vector<std::span<const float>> surfaces = {first, second};
  const Camera camera = fitted_camera(axes_of(View::kFront, UpAxis::kY), surfaces, 400, 200);
  const Vector3f left = camera.place({10, 0, 0});
  const Vector3f right = camera.place({14, 0, 0});
  EXPECT_NEAR(right.x() - left.x(), 376, 0.01f);
  EXPECT_NEAR(right.x(), 188, 0.01f);
  EXPECT_LT(left.y(), camera.place({12, -0.5f, 3}).y());  // rows go downwards
  EXPECT_LT(left.z(), camera.place({12, -0.5f, 3}).z());
}

TEST(CameraTest, ASinglePointIsInTheMiddle) {
  const std::vector<float> point = {1, 2, 3};
  const std::vector<std::span<const float>> surfaces = {point};
  const Camera camera = fitted_camera(axes_of(View::kIso, UpAxis::kY), surfaces, 10, 10);
  EXPECT_LT(camera.place({1, 2, 3}).norm(), 1e-3f);
}

TEST(CameraTest, ASurfaceBeyondSinglePrecisionHasAFiniteAspect) {
  const std::vector<float> points = {-3e38f, -3e38f, 0, 3e38f, 3e38f, 0};
  const std::array<std::span<const float>, 1> surfaces = {points};
  EXPECT_EQ(aspect_of(axes_of(View::kFront, UpAxis::kY), surfaces), 1.0f);
}

}  // namespace
}  // namespace semigeo::jobs
