#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "kernels/surface/surface.hpp"

namespace semigeo::kernels {

/// Turns every part that is inside out: a closed part that encloses a negative volume, whatever a
/// few vertices far out contribute to it, unless it lies inside another closed part, where it may
/// be the wall of a cavity; what lies inside such a part and is inverted with it, so that the walls
/// of its cavities still face the other way; and an open part most of whose faces look against
/// `normals`, one for each vertex, of any length, or none. Half-edges are renamed; vertices, faces
/// and parts keep their order. Returns the number of parts that were turned. The cost is linear,
/// and for parts inside others the size of their surroundings besides.
std::int64_t turn_inverted_parts(Surface& surface, std::span<const Eigen::Vector3f> normals = {});

}  // namespace semigeo::kernels
