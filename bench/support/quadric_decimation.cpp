#include "bench/support/quadric_decimation.hpp"

#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include "bench/support/edit_mesh.hpp"

namespace semigeo::bench {

kernels::TriangleMesh quadric_decimated(const kernels::TriangleMesh& mesh, std::int64_t vertices) {
  EditMesh edited = edit_mesh(mesh);
  edited.request_face_normals();
  edited.update_face_normals();
  OpenMesh::Decimater::DecimaterT<EditMesh> decimater(edited);
  OpenMesh::Decimater::ModQuadricT<EditMesh>::Handle quadric;
  OpenMesh::Decimater::ModNormalFlippingT<EditMesh>::Handle flipping;
  decimater.add(quadric);
  decimater.add(flipping);
  decimater.initialize();
  decimater.decimate_to(static_cast<std::size_t>(vertices));
  return triangle_mesh(edited);
}

}  // namespace semigeo::bench
