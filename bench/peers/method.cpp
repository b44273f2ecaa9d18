#include "bench/peers/method.hpp"

#include <Eigen/Geometry>
#include <ctime>
#include <stdexcept>
#include <utility>

#include "kernels/repair/surface_builder.hpp"
#include "kernels/surface/vertex_order.hpp"

namespace semigeo::peers {

Subject make_subject(std::string name, kernels::TriangleMesh mesh,
                     std::vector<shapes::SurfacePoint> truth) {
  const kernels::BuiltSurface built = kernels::build_surface(std::move(mesh));
  if (!truth.empty() && built.repairs != kernels::SurfaceRepairs{})
    throw std::logic_error("a mesh with known curvature needs repairs");
  const auto order = kernels::locality_order(built.surface);
  Subject subject{std::move(name), kernels::reordered(built.surface, order), {}, {}};
  if (!truth.empty())
    for (const std::int32_t old : order) subject.truth.push_back(truth[old]);
  const auto& points = subject.surface.points;
  subject.normals.assign(points.size(), Eigen::Vector3d::Zero());
  for (const auto& t : subject.surface.triangles) {
    const Eigen::Vector3d a = points[t[0]].cast<double>();
    const Eigen::Vector3d normal =
        (points[t[1]].cast<double>() - a).cross(points[t[2]].cast<double>() - a);
    for (const std::int32_t v : t) subject.normals[v] += normal;
  }
  for (Eigen::Vector3d& normal : subject.normals) normal.stableNormalize();
  return subject;
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace semigeo::peers
