#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace semigeo::io {

/// A direction in four bytes. The sphere is projected on the octahedron |x| + |y| + |z| = 1, whose
/// lower half is folded outwards, so that x and y tell all; each is scaled from [-1, 1] to 16 bits.
/// The error is 0.004 degrees at most.
using PackedNormal = std::array<std::uint16_t, 2>;

/// Packs a direction. Zero and what is not finite become the z axis.
PackedNormal pack_normal(const Eigen::Vector3f& normal);

/// Unpacks a direction of unit length. Packing it again changes nothing.
Eigen::Vector3f unpack_normal(const PackedNormal& packed);

}  // namespace semigeo::io
