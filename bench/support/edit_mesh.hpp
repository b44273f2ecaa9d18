#pragma once

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <Eigen/Core>

#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::bench {

/// A mesh of OpenMesh. Its editing shares no code with semigeo's own.
using EditMesh = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;

/// Returns a point of OpenMesh as a point of Eigen.
inline Eigen::Vector3d eigen(const OpenMesh::Vec3d& p) {
  return {p[0], p[1], p[2]};
}
/// Returns a point of Eigen as a point of OpenMesh.
inline OpenMesh::Vec3d open_mesh(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

/// Returns the same mesh for editing. The mesh must be manifold and oriented alike, as
/// `kernels::build_surface` leaves it. Throws std::runtime_error if OpenMesh refuses a face.
EditMesh edit_mesh(const kernels::TriangleMesh& mesh);

/// Returns the vertices and faces that are left of an edited mesh. It closes the gaps in `mesh`.
kernels::TriangleMesh triangle_mesh(EditMesh& mesh);

}  // namespace semigeo::bench
