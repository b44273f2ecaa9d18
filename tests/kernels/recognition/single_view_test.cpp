#include "kernels/recognition/single_view.hpp"

#include <gtest/gtest.h>

#include "kernels/recognition/surface_samples.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::kernels {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// The upper part of a unit sphere, z > least, at a place in the file. Its origin is that place.
RecognitionModel part_of_sphere(double least, const Vector3d& place, bool rim = true) {
  const TriangleMesh sphere = shapes::icosphere(4);
  RecognitionModel model;
  for (const Vector3d& p : sphere.points) {
    if (p.z() < least) continue;
    model.samples.points.push_back(p.cast<float>());
    model.samples.normals.push_back(p.cast<float>());
  }
  if (rim) {
    model.samples.rim.assign(model.samples.points.size(), 0);
    model.samples.rim.front() = 1;
  }
  model.origin = place;
  model.diagonal = 3;
  return model;
}

TEST(EyeOfView, IsTheOriginOfTheFileIfAllFacesIt) {
  // From 2 above the centre one sees what is higher than 1/2.
  const RecognitionModel scene = part_of_sphere(0.52, {0, 0, -2});
  const auto eye = eye_of_view(scene);
  ASSERT_TRUE(eye);
  EXPECT_EQ(*eye, Vector3d(0, 0, 2));
}

TEST(EyeOfView, IsFarAwayIfAllFacesOneDirection) {
  // From the origin one would not see the lower part.
  const auto eye = eye_of_view(part_of_sphere(0.1, {0, 0, -2}));
  ASSERT_TRUE(eye);
  EXPECT_GT(eye->z(), 100);
  EXPECT_LT(eye->head<2>().norm(), 0.1 * eye->z());
}

TEST(EyeOfView, IsUnknownOfWhatNobodySeesFromOnePlace) {
  EXPECT_FALSE(eye_of_view(part_of_sphere(-0.5, {0, 0, -2})));
  EXPECT_FALSE(eye_of_view(part_of_sphere(-2, {0, 0, -2})));
}

TEST(EyeOfView, NeedsARim) {
  EXPECT_FALSE(eye_of_view(part_of_sphere(0.52, {0, 0, -2}, false)));
}

}  // namespace
}  // namespace semigeo::kernels
