#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "bench/recognition/bench_model.hpp"
#include "kernels/recognition/similarity.hpp"

namespace semigeo::recognition {

/// Tells how far a pose is from the true one. Lengths are in diagonals of the model at its true
/// size in the scene. All is infinite if there is no pose.
struct PoseError {
  /// Angle between the rotations, in degrees.
  double degrees = std::numeric_limits<double>::infinity();
  /// Distance between the places of the model's centre.
  double centre = std::numeric_limits<double>::infinity();
  /// Largest distance between the places of a corner of the model's bounding box.
  double box = std::numeric_limits<double>::infinity();
  /// Relative error of the scale.
  double scale = std::numeric_limits<double>::infinity();
  /// Mean distance of the posed model's vertices from its surface in the true pose.
  double surface = std::numeric_limits<double>::infinity();

  /// Returns whether there is a pose.
  bool known() const { return scale < std::numeric_limits<double>::infinity(); }
};

// A pose is right if its errors are at most these.
inline constexpr double kMaxDegrees = 5;     ///< Limit of PoseError::degrees.
inline constexpr double kMaxCentre = 0.05;   ///< Limit of PoseError::centre.
inline constexpr double kMaxScale = 0.05;    ///< Limit of PoseError::scale.
inline constexpr double kMaxSurface = 0.01;  ///< Limit of PoseError::surface.

/// Compares the pose that was found for a model with the true one.
PoseError pose_error(const BenchModel& model, const kernels::Similarity& found,
                     const kernels::Similarity& truth);

/// Returns whether a pose is right: its rotation, centre and scale are, or its scale and surface
/// are. The second rule is for symmetric objects.
bool right(const PoseError& error);

}  // namespace semigeo::recognition
