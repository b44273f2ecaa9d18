#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "kernels/recognition/similarity.hpp"

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

/// Describes a motion that scales, and may turn, about the one point that it leaves where it is.
struct ScalingMotion {
  Eigen::Vector3d fixed_point;
  Eigen::Vector3d turn;  ///< Rotation vector, in radians for a factor of e.

  /// Returns the motion that scales by exp(log_scale).
  Similarity scaled(double log_scale) const;
};

/// Tells in which ways a surface can slip along itself, that is, by which motions its points stay
/// in their planes. Seven numbers say how firmly it is held in as many motions; 0 means that
/// it slips. They have no unit, because lengths are measured in radii of the surface. A surface of
/// revolution slips in one way, cylinders and cones in two, planes and spheres in more. A surface
/// that slips in two ways is no proof of where a model lies. Source: Gelfand et al. 2003 (stable
/// ICP), Gelfand and Guibas 2004. Differs: scaling is a seventh motion; stability compares the ways
/// of the points, not motions.
class Slippage {
 public:
  /// Examines a surface. Without points it is held by nothing.
  explicit Slippage(std::span<const OrientedPoint> surface);

  /// Returns how firmly the surface is held, from 0 to 1. It slips most easily by the motion of
  /// which the smallest share of the points' squared ways leads out of their planes. The result is
  /// that share for the second of seven such motions. A thin rod that is not round turns about its
  /// axis by short ways, but out of its planes, so it is held; a round one is not. `tolerance` is
  /// the length of ways that are too short to tell.
  double stability(double tolerance) const;

  /// Returns the axis about which the surface can turn along itself. The result is empty unless the
  /// motion that is held least is a rotation, and is held by no more than `most`.
  std::optional<Axis> free_rotation(double most) const;

  /// Returns how the surface can grow and shrink along itself: three faces of a box can, about
  /// their corner, and a cone about its apex. Of all motions that are held by no more than `most`,
  /// it is the one that scales most. The result is empty if less than a tenth of it is scaling.
  std::optional<ScalingMotion> free_scaling(double most) const;

 private:
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
  double radius_ = 0;
  Eigen::Matrix<double, 7, 7> across_ = Eigen::Matrix<double, 7, 7>::Zero();  ///< Out of planes.
  Eigen::Matrix<double, 7, 7> ways_ = Eigen::Matrix<double, 7, 7>::Zero();    ///< In all.
  Constraint held_ = Constraint::Zero();  ///< The seven numbers, ascending.
  /// Column i is the motion that held_[i] belongs to, of length 1.
  Eigen::Matrix<double, 7, 7> motions_ = Eigen::Matrix<double, 7, 7>::Zero();
};

}  // namespace semigeo::kernels
