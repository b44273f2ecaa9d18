#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace semigeo::kernels {

/// Holds a point of a surface and the unit normal there.
struct OrientedPoint {
  Eigen::Vector3f point;
  Eigen::Vector3f normal;
};

/// Holds how the distance from a plane changes with rotation (first three numbers), translation
/// (next three) and scaling (last).
using Constraint = Eigen::Matrix<double, 7, 1>;

/// Returns how the distance of a point from its tangent plane changes when the surface is rotated,
/// translated and scaled about a centre. `arm` leads from the centre to the point.
Constraint plane_constraint(const Eigen::Vector3d& arm, const Eigen::Vector3d& normal);

/// Describes the axis of a rotation.
struct Axis {
  Eigen::Vector3d point;
  Eigen::Vector3d direction;  ///< Of unit length.
};

/// Tells in which ways a surface can slip along itself, that is, by which motions its points stay
/// in their planes. Seven numbers say how firmly it is held in as many motions; 0 means that
/// it slips. They have no unit, because lengths are measured in radii of the surface. A surface of
/// revolution slips in one way, cylinders and cones in two, planes and spheres in more. A surface
/// that slips in two ways is no proof of where a model lies. Source: Gelfand et al. 2003 (stable
/// ICP), Gelfand and Guibas 2004. Differs: scaling is a seventh motion.
class Slippage {
 public:
  /// Examines a surface. Without points it is held by nothing.
  explicit Slippage(std::span<const OrientedPoint> surface);

  /// Returns the second smallest of the seven numbers.
  double stability() const;

  /// Returns the axis about which the surface can turn along itself. The result is empty unless the
  /// motion that is held least is a rotation, and is held by no more than `most`.
  std::optional<Axis> free_rotation(double most) const;

 private:
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
  double radius_ = 0;
  Constraint held_ = Constraint::Zero();   ///< The seven numbers, ascending.
  Constraint least_ = Constraint::Zero();  ///< The motion that is held least, of length 1.
};

}  // namespace semigeo::kernels
