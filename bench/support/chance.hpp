#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>
#include <string_view>

#include "kernels/recognition/similarity.hpp"

namespace semigeo::bench {

using Random = std::mt19937_64;

/// Numbers of their own for each seed, purpose and name, the same on every machine.
Random random(std::uint64_t seed, std::uint32_t purpose, std::string_view name);

/// Three independent normal numbers; normalised, any direction alike.
Eigen::Vector3d normal_vector(Random& random);

/// Any rotation alike.
Eigen::Matrix3d random_rotation(Random& random);

/// Any rotation, a factor between 1/2 and 2, and a shift of about `size`.
kernels::Similarity random_similarity(double size, Random& random);

/// Where a similarity takes this point from.
inline Eigen::Vector3d undo(const kernels::Similarity& similarity, const Eigen::Vector3d& p) {
  return similarity.rotation.transpose() * (p - similarity.translation) / similarity.scale;
}

}  // namespace semigeo::bench
