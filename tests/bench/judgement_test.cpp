#include "bench/recognition/judgement.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "tests/support/shapes.hpp"

namespace semigeo::recognition {
namespace {

kernels::Similarity turned(double degrees, const Eigen::Vector3d& axis) {
  kernels::Similarity s;
  s.rotation = Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis).toRotationMatrix();
  return s;
}

TEST(PoseError, IsNoneOfTheTruth) {
  const auto model = make_model("cube", shapes::cube(2, 4), 0);
  kernels::Similarity truth = turned(30, Eigen::Vector3d(1, 2, 3).normalized());
  truth.scale = 1.5;
  truth.translation = {4, 5, 6};
  const PoseError error = pose_error(*model, truth, truth);
  EXPECT_LT(error.degrees, 1e-5);
  EXPECT_LT(error.centre + error.box + error.scale, 1e-12);
  EXPECT_LT(error.surface, 1e-6);
  EXPECT_TRUE(right(error));
}

TEST(PoseError, MeasuresInDegreesAndDiagonalsOfTheTruth) {
  const auto model = make_model("cube", shapes::cube(2, 4), 0);
  kernels::Similarity truth, found = turned(10, Eigen::Vector3d::UnitZ());
  truth.scale = 2;
  found.scale = 2.2;
  const double diagonal = 2 * 2 * std::sqrt(3.0);
  found.translation = {0.05 * diagonal, 0, 0};
  const PoseError error = pose_error(*model, found, truth);
  EXPECT_NEAR(error.degrees, 10, 1e-6);
  EXPECT_NEAR(error.scale, 0.1, 1e-12);
  EXPECT_NEAR(error.centre, 0.05, 1e-6);
  EXPECT_GT(error.box, error.centre);
  EXPECT_FALSE(right(error));
}

TEST(PoseError, OfAMirrorPlaneApartFromTheModelsCentre) {
  // A model far from its coordinate origin: the rotation is about the origin, the centre goes far.
  kernels::TriangleMesh cube = shapes::cube(2, 4);
  for (auto& p : cube.points) p += Eigen::Vector3d(100, 0, 0);
  const auto model = make_model("cube", std::move(cube), 0);
  const PoseError error =
      pose_error(*model, turned(4, Eigen::Vector3d::UnitZ()), kernels::Similarity());
  EXPECT_NEAR(error.centre, 2 * 100 * std::sin(2 * std::numbers::pi / 180) / model->diagonal, 1e-4);
  EXPECT_FALSE(right(error));
}

TEST(Right, SymmetricObjectsByTheirSurface) {
  const auto torus = make_model("torus", shapes::torus(1, 0.4, 90, 40), 0);
  const kernels::Similarity truth;
  // About its axis nothing changes, about another one much.
  EXPECT_TRUE(right(pose_error(*torus, turned(77, Eigen::Vector3d::UnitZ()), truth)));
  EXPECT_FALSE(right(pose_error(*torus, turned(77, Eigen::Vector3d::UnitX()), truth)));
  kernels::Similarity larger = truth;
  larger.scale = 1.06;
  EXPECT_FALSE(right(pose_error(*torus, larger, truth)));
  EXPECT_FALSE(right(PoseError()));
}

}  // namespace
}  // namespace semigeo::recognition
