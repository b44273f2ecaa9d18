#include "kernels/recognition/slippage.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace semigeo::kernels {
namespace {

using Eigen::Vector3d;
using Matrix7d = Eigen::Matrix<double, 7, 7>;

/// The least share of the rotation in the squared length of a motion. With less, the axis lies more
/// than three radii away, or there is none.
constexpr double kLeastTurn = 0.1;

}  // namespace

Constraint plane_constraint(const Vector3d& arm, const Vector3d& normal) {
  Constraint constraint;
  constraint << arm.cross(normal), normal, arm.dot(normal);
  return constraint;
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
  Matrix7d sum = Matrix7d::Zero();
  for (const OrientedPoint& p : surface)
    sum.selfadjointView<Eigen::Lower>().rankUpdate(
        plane_constraint((p.point.cast<double>() - middle_) / radius_, p.normal.cast<double>()),
        share);
  const Eigen::SelfAdjointEigenSolver<Matrix7d> solver(sum);
  held_ = solver.eigenvalues().cwiseMax(0);
  least_ = solver.eigenvectors().col(0);
}

double Slippage::stability() const {
  return held_[1];
}

std::optional<Axis> Slippage::free_rotation(double most) const {
  const Vector3d turn = least_.head<3>();
  const Vector3d shift = least_.segment<3>(3);
  if (held_[0] > most || turn.squaredNorm() < kLeastTurn) return std::nullopt;
  // On the axis, turn x arm + shift has no part across the axis.
  return Axis{middle_ + radius_ * turn.cross(shift) / turn.squaredNorm(), turn.normalized()};
}

}  // namespace semigeo::kernels
