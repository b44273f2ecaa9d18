#include "bench/support/edit_mesh.hpp"

#include <stdexcept>
#include <vector>

namespace semigeo::bench {

EditMesh edit_mesh(const kernels::TriangleMesh& mesh) {
  EditMesh result;
  result.request_vertex_status();
  result.request_edge_status();
  result.request_halfedge_status();
  result.request_face_status();
  std::vector<EditMesh::VertexHandle> vertices;
  vertices.reserve(mesh.points.size());
  for (const Eigen::Vector3d& p : mesh.points) vertices.push_back(result.add_vertex(open_mesh(p)));
  for (const auto& t : mesh.triangles)
    if (!result.add_face(vertices[t[0]], vertices[t[1]], vertices[t[2]]).is_valid())
      throw std::runtime_error("OpenMesh cannot hold this mesh");
  return result;
}

kernels::TriangleMesh triangle_mesh(EditMesh& mesh) {
  mesh.garbage_collection();
  kernels::TriangleMesh result;
  result.points.reserve(mesh.n_vertices());
  for (const auto v : mesh.vertices()) result.points.push_back(eigen(mesh.point(v)));
  result.triangles.reserve(mesh.n_faces());
  for (const auto f : mesh.faces()) {
    auto& triangle = result.triangles.emplace_back();
    int corner = 0;
    for (const auto v : mesh.fv_range(f)) triangle[corner++] = v.idx();
  }
  return result;
}

}  // namespace semigeo::bench
