#include "bench/support/chance.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <vector>

namespace semigeo::bench {

Random random(std::uint64_t seed, std::uint32_t purpose, std::string_view name) {
  std::vector<std::uint32_t> words = {static_cast<std::uint32_t>(seed),
                                      static_cast<std::uint32_t>(seed >> 32), purpose};
  for (const char c : name) words.push_back(static_cast<unsigned char>(c));
  std::seed_seq sequence(words.begin(), words.end());
  return Random(sequence);
}

Eigen::Vector3d normal_vector(Random& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random);
  const double y = normal(random);
  return {x, y, normal(random)};
}

Eigen::Matrix3d random_rotation(Random& random) {
  std::normal_distribution<double> normal;
  std::array<double, 4> q{};
  for (double& x : q) x = normal(random);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

kernels::Similarity random_similarity(double size, Random& random) {
  kernels::Similarity result;
  result.rotation = random_rotation(random);
  result.scale = std::exp2(std::uniform_real_distribution(-1.0, 1.0)(random));
  result.translation = size * normal_vector(random);
  return result;
}

}  // namespace semigeo::bench
