#pragma once

#include <cstdint>

#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::bench {

/// Returns a mesh whose edges were collapsed by OpenMesh, in the order of the quadric error, until
/// `vertices` vertices are left or no edge can be collapsed. No face is turned over. The vertices
/// that are left keep their places. Throws as `edit_mesh` does.
kernels::TriangleMesh quadric_decimated(const kernels::TriangleMesh& mesh, std::int64_t vertices);

}  // namespace semigeo::bench
