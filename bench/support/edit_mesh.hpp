#pragma once

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <Eigen/Core>

#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::bench {

/// An editor of meshes that shares nothing with semigeo's own.
using EditMesh = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;

inline Eigen::Vector3d eigen(const OpenMesh::Vec3d& p) {
  return {p[0], p[1], p[2]};
}
inline OpenMesh::Vec3d open_mesh(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

/// The mesh must be manifold and oriented alike, as `kernels::build_surface` leaves it; throws
/// std::runtime_error if OpenMesh refuses a face.
EditMesh edit_mesh(const kernels::TriangleMesh& mesh);

/// What is left of an edited mesh. Closes the gaps in `mesh` first.
kernels::TriangleMesh triangle_mesh(EditMesh& mesh);

}  // namespace semigeo::bench
