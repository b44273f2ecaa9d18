#pragma once

#include <Eigen/Core>

#include "bench/support/chance.hpp"
#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::recognition {

/// Returns how far `moving` can be shifted against `direction` (of unit length), coming from far
/// away, until a vertex of one mesh meets a face of the other. The result is negative if they meet
/// before `moving` reaches its place, and infinite if they never meet. Edges that cross each other
/// away from all vertices are not noticed.
double way_to_contact(const kernels::TriangleMesh& moving, const kernels::TriangleMesh& still,
                      const Eigen::Vector3d& direction);

/// Returns the shift by which `moving`, pushed from a random side, comes to touch `still`. No
/// vertex of one mesh is then inside the other. It is pushed towards the centre of the bounding box
/// of `still`, or past it by up to a quarter of the smaller box.
/// Throws std::runtime_error if the objects miss each other from every side that was tried.
Eigen::Vector3d touching_shift(const kernels::TriangleMesh& moving,
                               const kernels::TriangleMesh& still, bench::Random& random);

}  // namespace semigeo::recognition
