#include "kernels/evolution.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "kernels/curvature.hpp"

namespace semigeo::kernels {

EvolvedVertex evolve_vertex(const SampledSurface& surface, std::int32_t v, float step) {
  const GeodesicMesh& mesh = surface.mesh;
  EvolvedVertex result{mesh.point(v), mesh.normals[v], 0, 0, 0};
  Patch patch;
  trace_patch(surface, v, first_edge(mesh, v), step, patch);

  PatchDerivatives d;
  float completeness = 1;
  bool valid = true;
  if (patch.whole()) {
    d = convolve(patch, step);
  } else {
    const TruncatedDerivatives truncated = fit_truncated(patch, step);
    d = truncated.derivatives;
    completeness = patch.completeness();
    valid = truncated.ok && completeness >= kMinCompleteness;
  }
  const Eigen::Vector3f position = mesh.point(v) + d.r;
  if (position.allFinite()) result.position = position;
  if (!valid || !(d.ru.cross(d.rv).norm() >= kMinTangentArea)) return result;

  const Curvature c = surface.curved.empty() ? curvature_semigeodesic(d) : curvature_from_forms(d);
  const bool finite = std::isfinite(c.gaussian) && std::isfinite(c.mean) && c.normal.allFinite();
  if (!finite || c.normal.isZero(0)) return result;
  result.normal = c.normal;
  result.gaussian_curvature = c.gaussian;
  result.mean_curvature = c.mean;
  result.patch_completeness = completeness;
  return result;
}

}  // namespace semigeo::kernels
