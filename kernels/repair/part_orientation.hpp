#pragma once

#include <cstdint>

#include "kernels/surface/surface.hpp"

namespace semigeo::kernels {

/// Turns every closed part inside out that encloses a negative volume, whatever a few vertices far
/// out contribute to it, unless it lies inside
/// another closed part: then it may be the wall of a cavity. Half-edges are renamed; vertices,
/// faces and parts keep their order. Returns the number of parts that were turned. The cost is
/// linear, and for parts inside others the size of their surroundings besides.
std::int64_t turn_inverted_parts(Surface& surface);

}  // namespace semigeo::kernels
