#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace semigeo::kernels {

/// A point of a surface and the unit normal there.
struct OrientedPoint {
  Eigen::Vector3f point;
  Eigen::Vector3f normal;
};

using Constraint = Eigen::Matrix<double, 7, 1>;

/// How the distance of a point from its plane changes when it turns (first three), shifts (three)
/// and grows (last) about a middle; `arm` leads from there to the point.
Constraint plane_constraint(const Eigen::Vector3d& arm, const Eigen::Vector3d& normal);

/// A line to turn about.
struct Axis {
  Eigen::Vector3d point;
  Eigen::Vector3d direction;  ///< unit
};

/// In which ways a surface can slip along itself: motions that leave its points in their planes.
/// Seven numbers tell how firmly it is held, 0 where it slips; without unit, as arms are in radii
/// about the middle. A surface of revolution slips in one way, cylinders and cones in two, planes
/// and spheres in more. A surface that slips in two is no proof of where a model lies.
/// Source: Gelfand et al. 2003 (stable ICP), Gelfand and Guibas 2004. Differs: it may grow, too.
class Slippage {
 public:
  /// Of no points: held by nothing.
  explicit Slippage(std::span<const OrientedPoint> surface);

  /// The second smallest of the seven.
  double stability() const;

  /// What it can turn about along itself, if the way in which it is held least is a turn, and held
  /// by no more than `most`.
  std::optional<Axis> free_turn(double most) const;

 private:
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
  double radius_ = 0;
  Constraint held_ = Constraint::Zero();   ///< ascending
  Constraint least_ = Constraint::Zero();  ///< the motion that is held least, of length 1
};

}  // namespace semigeo::kernels
