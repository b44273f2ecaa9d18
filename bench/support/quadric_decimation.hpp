#pragma once

#include <cstdint>

#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::bench {

/// Collapses edges until so many vertices are left, or no edge can be collapsed any more: the one
/// first whose target lies nearest to the planes of all the faces merged so far (quadric error;
/// OpenMesh). No face is turned over. The vertices left are some of those that were there. Throws
/// as `edit_mesh` does.
kernels::TriangleMesh quadric_decimated(const kernels::TriangleMesh& mesh, std::int64_t vertices);

}  // namespace semigeo::bench
