#pragma once

#include <Eigen/Core>
#include <array>

namespace semigeo::kernels {

/// A similarity transform: x becomes scale * rotation * x + translation.
struct Similarity {
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  /// Returns where a point goes.
  Eigen::Vector3d apply(const Eigen::Vector3d& p) const {
    return scale * (rotation * p) + translation;
  }
  /// Returns the transform that undoes this one.
  Similarity inverse() const;
  /// Returns the 4 x 4 matrix for homogeneous column vectors.
  Eigen::Matrix4d matrix() const;
};

/// Returns the similarity that applies `second` and then `first`.
Similarity operator*(const Similarity& first, const Similarity& second);

/// Returns the angle of the rotation that leads from a to b, in radians, 0 to pi.
double rotation_between(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b);

/// Holds angles in radians with R = Rz(alpha) Ry(beta) Rx(gamma). Where beta is a quarter turn,
/// gamma is 0. Source: thesis 4.6, (4.21).
struct EulerAngles {
  double gamma = 0;
  double beta = 0;
  double alpha = 0;
};
/// Returns the Euler angles of a rotation.
EulerAngles euler_angles(const Eigen::Matrix3d& rotation);

/// Holds three points with unit normals.
struct OrientedTriangle {
  std::array<Eigen::Vector3d, 3> points;
  std::array<Eigen::Vector3d, 3> normals;
};

/// Returns the similarity that takes `from` to `to`, corner by corner. The scale comes from the
/// perimeters, the rotation from edges and normals together, the translation from the centroids.
/// The result is exact where there is an exact one. Source: thesis 4.6, (4.19), (4.20). Differs:
/// the equations (4.19) are singular, and their reduced form gives affine transforms.
Similarity similarity_between(const OrientedTriangle& from, const OrientedTriangle& to);

}  // namespace semigeo::kernels
