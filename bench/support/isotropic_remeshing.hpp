#pragma once

#include <cstdint>

#include "kernels/surface/surface.hpp"
#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::bench {

/// Lays a new mesh of about so many vertices over a surface, with edges of about the same length
/// everywhere: long edges are split, short ones collapsed, edges flipped towards six neighbours a
/// vertex, vertices moved along the surface to the middle of their neighbours and back onto it, ten
/// times over. What is sharper than an edge is long is cut off, as by a scanner. The number of
/// vertices is off by a few per cent. Boundaries keep their vertices. Throws std::runtime_error if
/// OpenMesh cannot hold the surface. Serial; about 0.1 ms a vertex.
kernels::TriangleMesh isotropic_remeshed(const kernels::Surface& surface, std::int64_t vertices);

}  // namespace semigeo::bench
