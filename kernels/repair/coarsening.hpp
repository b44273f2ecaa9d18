#pragma once

#include <span>

#include "kernels/repair/remeshing.hpp"

namespace semigeo::kernels {

/// Coarsens the parts of a mesh until their mean edge lengths are about `lengths` (a length for
/// each part, or 0 for a part that is left alone). Vertices that stay keep all that they carry, so
/// that curved faces go on interpolating the same surface. The mesh keeps all that
/// kernels/surface/connectivity.hpp promises, its parts, its boundary loops and its genus. Returns
/// what was done, as collapses and flips. It is serial; the result depends on the mesh alone. The
/// cost is linear.
///
/// Two neighbours become one of them if together they stand for no more area than a vertex of the
/// coarse mesh may, the smallest areas first, and the shortest edge of a vertex first. An edge
/// stays where a face would turn from the normals of its corners or become a needle, where a rim
/// would move by a noticeable part of the length, and where the surface would be pinched. At last
/// edges are flipped until the angles opposite to each are less than 180 degrees together.
RemeshCounts coarsen(LevelMesh& mesh, std::span<const double> lengths);

}  // namespace semigeo::kernels
