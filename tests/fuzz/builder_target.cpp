// The repair of triangles to a manifold, the filling of holes and the remeshing of what results.
#include <cmath>

#include "kernels/repair/surface_builder.hpp"
#include "tests/fuzz/made_mesh.hpp"
#include "tests/fuzz/target.hpp"
#include "tests/support/manifold.hpp"

namespace semigeo::fuzz {

void read_input(std::string_view bytes) {
  Numbers numbers(bytes);
  kernels::Welding welding;
  const unsigned gaps = numbers.below(4);
  if (gaps > 0) welding.distance = 0.25 * (gaps - 1);
  kernels::TriangleMesh mesh = made_mesh(numbers);
  const auto faces = static_cast<std::int64_t>(mesh.triangles.size());
  const kernels::BuiltSurface built = kernels::build_surface(std::move(mesh), welding);
  const kernels::SurfaceRepairs& repairs = built.repairs;
  check(built.surface.face_count() + repairs.degenerate_faces + repairs.duplicate_faces == faces,
        "faces are neither kept nor counted");
  check(std::isfinite(built.coordinate_step), "the step is not finite");
  kernels::TriangleMesh manifold;
  for (const Eigen::Vector3f& point : built.surface.points)
    manifold.points.push_back(point.cast<double>());
  manifold.triangles = built.surface.triangles;
  const std::string fault = tests::why_not_manifold(manifold);
  check(fault.empty(), fault.c_str());
  const std::vector<std::int32_t>& twin = built.surface.twin;
  for (std::int32_t h = 0; h < std::ssize(twin); ++h) {
    if (kernels::corner_of(h) == 3 || twin[h] == kernels::kNone) continue;
    check(twin[twin[h]] == h, "a half-edge is not the twin of its twin");
    check(built.surface.origin(h) == built.surface.target(twin[h]), "a twin runs elsewhere");
  }
}

}  // namespace semigeo::fuzz
