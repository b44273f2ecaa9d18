#pragma once

#include <Eigen/Core>

#include "bench/support/chance.hpp"
#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::recognition {

/// How far `moving` can go against `direction` (unit) before it meets `still`, if it comes from
/// afar: until a vertex of one meets a face of the other. Negative: it meets farther out. Infinite
/// if it passes by. Edges that cross without a vertex between them are not noticed.
double way_to_contact(const kernels::TriangleMesh& moving, const kernels::TriangleMesh& still,
                      const Eigen::Vector3d& direction);

/// The shift by which `moving`, pushed from a random side, comes to touch `still`: no vertex of one
/// is inside the other. About centres of bounding boxes; off centre by up to a quarter of the
/// smaller box.
Eigen::Vector3d touching_shift(const kernels::TriangleMesh& moving,
                               const kernels::TriangleMesh& still, bench::Random& random);

}  // namespace semigeo::recognition
