#pragma once

#include "kernels/surface/triangle_mesh.hpp"
#include "tests/fuzz/target.hpp"

namespace semigeo::fuzz {

/// Returns a mesh of at most about 100 points that the numbers describe: a soup of triangles, a
/// grid or a ball, in which faces are then dropped, doubled, turned over or joined to other points.
/// Its indices are valid and its points finite.
kernels::TriangleMesh made_mesh(Numbers& numbers);

}  // namespace semigeo::fuzz
