#pragma once

#include <Eigen/Geometry>
#include <random>

#include "kernels/recognition/similarity.hpp"

namespace semigeo {

/// A unit vector, every direction alike.
inline Eigen::Vector3d random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
}

/// Any rotation, a scale of 0.3 to 3, a translation of up to 5 in each coordinate.
inline kernels::Similarity random_similarity(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Eigen::Quaterniond turn(normal(random), normal(random), normal(random), normal(random));
  return {.scale = std::pow(3.0, uniform(random)),
          .rotation = turn.normalized().toRotationMatrix(),
          .translation = 5 * Eigen::Vector3d(uniform(random), uniform(random), uniform(random))};
}

}  // namespace semigeo
