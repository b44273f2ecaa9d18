#include "kernels/recognition/slippage.hpp"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace semigeo::kernels {
namespace {

using Eigen::Vector3d;
using Matrix7d = Eigen::Matrix<double, 7, 7>;

/// The least share of the rotation in the squared length of a motion. With less, the axis lies more
/// than three radii away, or there is none.
constexpr double kLeastTurn = 0.1;
/// The least share of the scaling in the squared length of a motion.
constexpr double kLeastScaling = 0.1;
/// The least tolerance, in radii. Points of a line do not move when they turn about it.
constexpr double kLeastWay = 1e-6;

}  // namespace

Constraint plane_constraint(const Vector3d& arm, const Vector3d& normal) {
  Constraint constraint;
  constraint << arm.cross(normal), normal, arm.dot(normal);
  return constraint;
}

Similarity ScalingMotion::scaled(double log_scale) const {
  Similarity motion;
  const Vector3d turned = log_scale * turn;
  if (turned.norm() > 0)
    motion.rotation = Eigen::AngleAxisd(turned.norm(), turned.normalized()).toRotationMatrix();
  motion.scale = std::exp(log_scale);
  motion.translation = fixed_point - motion.scale * (motion.rotation * fixed_point);
  return motion;
}

Slippage::Slippage(std::span<const OrientedPoint> surface) {
  if (surface.empty()) return;
  const double share = 1 / static_cast<double>(surface.size());
  for (const OrientedPoint& p : surface) middle_ += share * p.point.cast<double>();
  double squared = 0;
  for (const OrientedPoint& p : surface)
    squared += share * (p.point.cast<double>() - middle_).squaredNorm();
  if (!(squared > 0)) return;
  radius_ = std::sqrt(squared);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const OrientedPoint& p : surface) {
    const Vector3d arm = (p.point.cast<double>() - middle_) / radius_;
    across_.selfadjointView<Eigen::Lower>().rankUpdate(
        plane_constraint(arm, p.normal.cast<double>()), share);
    spread += share * arm * arm.transpose();
  }
  // Points move by turn x arm + shift + scaling arm. The arms have the mean 0 and the mean
  // square 1.
  ways_.setIdentity();
  ways_.topLeftCorner<3, 3>() -= spread;
  const Eigen::SelfAdjointEigenSolver<Matrix7d> solver(across_);
  held_ = solver.eigenvalues().cwiseMax(0);
  motions_ = solver.eigenvectors();
}

double Slippage::stability(double tolerance) const {
  if (!(radius_ > 0)) return 0;
  const double least_way = std::max(tolerance / radius_, kLeastWay);
  const Matrix7d ways = ways_ + least_way * least_way * Matrix7d::Identity();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix7d> solver(across_, ways,
                                                                  Eigen::EigenvaluesOnly);
  return std::max(solver.eigenvalues()[1], 0.0);
}

std::optional<Axis> Slippage::free_rotation(double most) const {
  const Vector3d turn = motions_.col(0).head<3>();
  const Vector3d shift = motions_.col(0).segment<3>(3);
  if (held_[0] > most || turn.squaredNorm() < kLeastTurn) return std::nullopt;
  // On the axis, turn x arm + shift has no part across the axis.
  return Axis{middle_ + radius_ * turn.cross(shift) / turn.squaredNorm(), turn.normalized()};
}

std::optional<ScalingMotion> Slippage::free_scaling(double most) const {
  Constraint motion = Constraint::Zero();  // scaling alone, projected onto what is free
  for (int i = 0; i < motion.size() && held_[i] <= most; ++i)
    motion += motions_(6, i) * motions_.col(i);
  const double scaling = motion[6];
  if (scaling < kLeastScaling) return std::nullopt;
  const Vector3d turn = motion.head<3>() / scaling;
  const Vector3d shift = motion.segment<3>(3) / scaling;
  // Where the arm does not move: arm + turn x arm + shift = 0.
  Eigen::Matrix3d velocity;
  velocity << 1, -turn.z(), turn.y(), turn.z(), 1, -turn.x(), -turn.y(), turn.x(), 1;
  return ScalingMotion{middle_ - radius_ * velocity.inverse() * shift, turn};
}

}  // namespace semigeo::kernels
