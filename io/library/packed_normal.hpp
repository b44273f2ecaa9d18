#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace semigeo::io {

/// A direction in four bytes: the sphere is projected on the octahedron |x| + |y| + |z| = 1, whose
/// lower half is folded outwards, so that x and y tell all; each is scaled from [-1, 1] to 16 bits.
/// Off by 0.004 degrees at most.
using PackedNormal = std::array<std::uint16_t, 2>;

/// Zero and what is not finite become the z axis.
PackedNormal pack_normal(const Eigen::Vector3f& normal);

/// Unit length. Packing it again changes nothing.
Eigen::Vector3f unpack_normal(const PackedNormal& packed);

}  // namespace semigeo::io
