#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>
#include <string_view>

#include "kernels/recognition/similarity.hpp"

namespace semigeo::bench {

/// The generator of all random numbers.
using Random = std::mt19937_64;

/// Returns a generator for a seed, a purpose and a name. The same three give the same numbers on
/// every machine, and others give other numbers.
Random random(std::uint64_t seed, std::uint32_t purpose, std::string_view name);

/// Returns a vector of three independent normal numbers. Its direction is uniformly distributed.
Eigen::Vector3d normal_vector(Random& random);

/// Returns a uniformly distributed rotation.
Eigen::Matrix3d random_rotation(Random& random);

/// Returns a random rotation with a scale between 1/2 and 2 and a translation of about `size`.
kernels::Similarity random_similarity(double size, Random& random);

/// Returns the point that a similarity takes to p.
inline Eigen::Vector3d undo(const kernels::Similarity& similarity, const Eigen::Vector3d& p) {
  return similarity.rotation.transpose() * (p - similarity.translation) / similarity.scale;
}

}  // namespace semigeo::bench
