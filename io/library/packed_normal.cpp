#include "io/library/packed_normal.hpp"

#include <algorithm>
#include <cmath>

namespace semigeo::io {
namespace {

constexpr double kHalf = 32767;  // 0 is stored exactly, as 32767

std::uint16_t to_bits(double value) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(value, -1.0, 1.0) * kHalf) + 32767);
}

double from_bits(std::uint16_t bits) {
  return (std::min<int>(bits, 65534) - 32767) / kHalf;
}

// Returns a coordinate of a point of the lower half after it was folded outwards, or back.
double folded(double along, double across) {
  return (1 - std::abs(across)) * (along >= 0 ? 1 : -1);
}

}  // namespace

PackedNormal pack_normal(const Eigen::Vector3f& normal) {
  const Eigen::Vector3d n = normal.cast<double>();
  const double sum = n.cwiseAbs().sum();
  if (!(sum > 0) || !std::isfinite(sum)) return {32767, 32767};
  const double x = n.x() / sum;
  const double y = n.y() / sum;
  if (n.z() >= 0) return {to_bits(x), to_bits(y)};
  return {to_bits(folded(x, y)), to_bits(folded(y, x))};
}

Eigen::Vector3f unpack_normal(const PackedNormal& packed) {
  double x = from_bits(packed[0]);
  double y = from_bits(packed[1]);
  const double z = 1 - std::abs(x) - std::abs(y);
  if (z < 0) {
    const double inner_x = folded(x, y);
    y = folded(y, x);
    x = inner_x;
  }
  return Eigen::Vector3d(x, y, z).normalized().cast<float>();
}

}  // namespace semigeo::io
