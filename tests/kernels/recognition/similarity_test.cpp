#include "kernels/recognition/similarity.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "tests/support/random_similarity.hpp"

namespace semigeo::kernels {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

OrientedTriangle random_triangle(std::mt19937_64& random) {
  OrientedTriangle triangle;
  for (int i = 0; i < 3; ++i) {
    triangle.points[i] = random_direction(random);
    triangle.normals[i] = random_direction(random);
  }
  return triangle;
}

OrientedTriangle moved(const OrientedTriangle& triangle, const Similarity& similarity) {
  OrientedTriangle result;
  for (int i = 0; i < 3; ++i) {
    result.points[i] = similarity.apply(triangle.points[i]);
    result.normals[i] = similarity.rotation * triangle.normals[i];
  }
  return result;
}

TEST(Similarity, IsFoundAgainFromOneTriangle) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const Similarity truth = random_similarity(random);
    const OrientedTriangle triangle = random_triangle(random);
    const Similarity found = similarity_between(triangle, moved(triangle, truth));
    EXPECT_NEAR(found.scale / truth.scale, 1, 1e-10);
    EXPECT_LT((found.rotation - truth.rotation).norm(), 1e-9);
    EXPECT_LT((found.translation - truth.translation).norm(), 1e-8);
  }
}

TEST(Similarity, OfDifferentTrianglesIsARotationAllTheSame) {
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const Similarity found = similarity_between(random_triangle(random), random_triangle(random));
    EXPECT_LT((found.rotation * found.rotation.transpose() - Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(found.rotation.determinant(), 1, 1e-12);
  }
}

// The triangle of three points alone tells the rotation about a long thin triangle's side badly;
// their normals tell it well.
TEST(Similarity, NormalsHelpWhereTheTriangleIsNearlyALine) {
  std::mt19937_64 random(3);
  OrientedTriangle from;
  from.points = {Vector3d(0, 0.05, 0), Vector3d(-1, 0, 0), Vector3d(1, 0, 0)};
  for (Vector3d& normal : from.normals) normal = Vector3d(0, 0, 1);
  OrientedTriangle to = from;
  to.points[0] = Vector3d(0, 0.05 * std::cos(0.4), 0.05 * std::sin(0.4));  // noise
  const Similarity found = similarity_between(from, to);
  EXPECT_LT(rotation_between(found.rotation, Matrix3d::Identity()), 0.04);
}

TEST(Similarity, InverseAndProductUndoAndFollow) {
  std::mt19937_64 random(4);
  const Similarity a = random_similarity(random);
  const Similarity b = random_similarity(random);
  const Vector3d p = random_direction(random);
  EXPECT_LT(((a * b).apply(p) - a.apply(b.apply(p))).norm(), 1e-12);
  EXPECT_LT((a.inverse().apply(a.apply(p)) - p).norm(), 1e-12);
  EXPECT_LT(((a.matrix() * p.homogeneous()).head<3>() - a.apply(p)).norm(), 1e-12);
}

TEST(Similarity, AngleBetweenRotations) {
  const Vector3d axis = Vector3d(1, 2, 3).normalized();
  for (const double angle : {0.0, 1e-9, 0.3, 2.0, std::numbers::pi}) {
    const Matrix3d turned = AngleAxisd(angle, axis).toRotationMatrix();
    EXPECT_NEAR(rotation_between(Matrix3d::Identity(), turned), angle, 1e-7 * angle + 1e-12);
  }
}

Matrix3d composed(const EulerAngles& a) {
  return (AngleAxisd(a.alpha, Vector3d::UnitZ()) * AngleAxisd(a.beta, Vector3d::UnitY()) *
          AngleAxisd(a.gamma, Vector3d::UnitX()))
      .toRotationMatrix();
}

TEST(Similarity, SevenParametersMakeTheRotationAgain) {
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 100; ++trial) {
    const Matrix3d rotation = random_similarity(random).rotation;
    EXPECT_LT((composed(euler_angles(rotation)) - rotation).norm(), 1e-12);
  }
  for (const double beta : {-std::numbers::pi / 2, std::numbers::pi / 2}) {
    const Matrix3d rotation = composed({.gamma = 0.4, .beta = beta, .alpha = 1.1});
    EXPECT_LT((composed(euler_angles(rotation)) - rotation).norm(), 1e-7);
  }
}

}  // namespace
}  // namespace semigeo::kernels
