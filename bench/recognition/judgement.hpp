#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "bench/recognition/bench_model.hpp"
#include "kernels/recognition/similarity.hpp"

namespace semigeo::recognition {

/// How far a pose is from the true one. Lengths are shares of the diagonal that the model truly has
/// in the scene.
struct PoseError {
  double degrees = std::numeric_limits<double>::infinity();
  double centre = std::numeric_limits<double>::infinity();  ///< of the model's centre
  double box = std::numeric_limits<double>::infinity();     ///< of its box's corners, the largest
  double scale = std::numeric_limits<double>::infinity();   ///< relative
  /// From where the pose puts the model's vertices to where its surface truly is, mean.
  double surface = std::numeric_limits<double>::infinity();

  bool known() const { return scale < std::numeric_limits<double>::infinity(); }
};

inline constexpr double kMaxDegrees = 5;
inline constexpr double kMaxCentre = 0.05;
inline constexpr double kMaxScale = 0.05;
inline constexpr double kMaxSurface = 0.01;

PoseError pose_error(const BenchModel& model, const kernels::Similarity& found,
                     const kernels::Similarity& truth);

/// Rotation, place and scale are right; or scale and surface are, as of symmetric objects.
bool right(const PoseError& error);

}  // namespace semigeo::recognition
