#include "kernels/recognition/similarity.hpp"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace semigeo::kernels {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Returns a frame with these columns: along the side from corner 1 to corner 2, the height on it,
/// the normal of the triangle.
Matrix3d frame_of(const OrientedTriangle& t) {
  Matrix3d frame;
  frame.col(0) = (t.points[2] - t.points[1]).normalized();
  frame.col(2) = (t.points[1] - t.points[0]).cross(t.points[2] - t.points[0]).normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

Vector3d centroid_of(const OrientedTriangle& t) {
  return (t.points[0] + t.points[1] + t.points[2]) / 3;
}

double perimeter_of(const OrientedTriangle& t) {
  return (t.points[1] - t.points[0]).norm() + (t.points[2] - t.points[1]).norm() +
         (t.points[0] - t.points[2]).norm();
}

/// Returns corners and normals about the centroid: six directions of nearly the same weight.
std::array<Vector3d, 6> directions_of(const OrientedTriangle& t) {
  const Vector3d centroid = centroid_of(t);
  const double length = perimeter_of(t) / 3;
  std::array<Vector3d, 6> directions;
  for (int i = 0; i < 3; ++i) {
    directions[i] = (t.points[i] - centroid) / length;
    directions[3 + i] = t.normals[i];
  }
  return directions;
}

}  // namespace

Similarity Similarity::inverse() const {
  return {.scale = 1 / scale,
          .rotation = rotation.transpose(),
          .translation = -(rotation.transpose() * translation) / scale};
}

Eigen::Matrix4d Similarity::matrix() const {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = scale * rotation;
  matrix.topRightCorner<3, 1>() = translation;
  return matrix;
}

Similarity operator*(const Similarity& first, const Similarity& second) {
  return {.scale = first.scale * second.scale,
          .rotation = first.rotation * second.rotation,
          .translation = first.apply(second.translation)};
}

double rotation_between(const Matrix3d& a, const Matrix3d& b) {
  // The angle is computed from the chord. The arc cosine of the trace loses all digits at small
  // angles.
  return 2 * std::asin(std::min(1.0, (a - b).norm() / std::sqrt(8.0)));
}

EulerAngles euler_angles(const Matrix3d& rotation) {
  EulerAngles angles;
  const double cos_beta = std::hypot(rotation(0, 0), rotation(1, 0));
  angles.beta = std::atan2(-rotation(2, 0), cos_beta);  // (4.21)
  if (cos_beta > 1e-9) {
    angles.gamma = std::atan2(rotation(2, 1), rotation(2, 2));  // (4.21)
    angles.alpha = std::atan2(rotation(1, 0), rotation(0, 0));  // (4.21)
  } else {
    angles.alpha = std::atan2(-rotation(0, 1), rotation(1, 1));
  }
  return angles;
}

Similarity similarity_between(const OrientedTriangle& from, const OrientedTriangle& to) {
  Similarity result;
  result.scale = perimeter_of(to) / perimeter_of(from);
  result.rotation = frame_of(to) * frame_of(from).transpose();
  // The triangles alone determine a rotation. One step of least squares takes normals into account.
  const auto source = directions_of(from);
  const auto target = directions_of(to);
  Matrix3d inertia = Matrix3d::Zero();
  Vector3d moment = Vector3d::Zero();
  for (std::size_t i = 0; i < source.size(); ++i) {
    const Vector3d turned = result.rotation * source[i];
    inertia += turned.squaredNorm() * Matrix3d::Identity() - turned * turned.transpose();
    moment += turned.cross(target[i]);
  }
  const Vector3d turn = inertia.inverse() * moment;
  if (const double angle = turn.norm(); angle > 0 && std::isfinite(angle))
    result.rotation = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() * result.rotation;
  result.translation = centroid_of(to) - result.scale * (result.rotation * centroid_of(from));
  return result;
}

}  // namespace semigeo::kernels
