#pragma once

#include <Eigen/Geometry>
#include <functional>

#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::shapes {

/// Signed distance to a closed surface, negative inside. Near the surface it must be the true
/// distance.
using SignedDistance = std::function<double(const Eigen::Vector3d&)>;

/// Closed surface without slivers, oriented outwards: tetrahedra of a body-centred lattice are
/// marched, vertices then spread evenly. `cell` is the lattice constant, about 2.3 mean edge
/// lengths; parts thinner than that are lost. The surface must lie inside the box.
kernels::TriangleMesh isosurface(const SignedDistance& distance, const Eigen::AlignedBox3d& box,
                                 double cell);

}  // namespace semigeo::shapes
