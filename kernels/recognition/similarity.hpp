#pragma once

#include <Eigen/Core>
#include <array>

namespace semigeo::kernels {

/// x -> scale * rotation * x + translation.
struct Similarity {
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Eigen::Vector3d apply(const Eigen::Vector3d& p) const {
    return scale * (rotation * p) + translation;
  }
  Similarity inverse() const;
  Eigen::Matrix4d matrix() const;  ///< row by row, for column vectors
};

/// first after second.
Similarity operator*(const Similarity& first, const Similarity& second);

/// Angle of the rotation that leads from one to the other, in radians, 0 to pi.
double rotation_between(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b);

/// gamma, beta, alpha with R = Rz(alpha) Ry(beta) Rx(gamma), radians. Where beta is a quarter turn
/// gamma is 0. Source: thesis 4.6, (4.21).
struct EulerAngles {
  double gamma = 0;
  double beta = 0;
  double alpha = 0;
};
EulerAngles euler_angles(const Eigen::Matrix3d& rotation);

/// Three points with unit normals.
struct OrientedTriangle {
  std::array<Eigen::Vector3d, 3> points;
  std::array<Eigen::Vector3d, 3> normals;
};

/// The similarity that takes `from` to `to`, corner by corner: scale from the perimeters, rotation
/// from edges and normals together, centroid to centroid. Exact where there is an exact one.
/// Source: thesis 4.6, (4.19), (4.20). Differs: (4.19) is singular, its reduced form affine.
Similarity similarity_between(const OrientedTriangle& from, const OrientedTriangle& to);

}  // namespace semigeo::kernels
