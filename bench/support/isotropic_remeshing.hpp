#pragma once

#include <cstdint>

#include "kernels/surface/surface.hpp"
#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::bench {

/// Returns a new mesh of a surface whose edges are about equally long. It has `vertices` vertices,
/// give or take a few per cent. Ten times over, long edges are split, short edges are collapsed,
/// edges are flipped so that vertices have nearly six neighbours, and vertices are moved to the
/// centroid of their neighbours and back onto the surface. Details smaller than an edge are lost,
/// as they are by a scanner. Boundaries keep their vertices. Throws std::runtime_error if OpenMesh
/// cannot hold the surface. The function is serial and takes about 0.1 ms for each vertex.
kernels::TriangleMesh isotropic_remeshed(const kernels::Surface& surface, std::int64_t vertices);

}  // namespace semigeo::bench
