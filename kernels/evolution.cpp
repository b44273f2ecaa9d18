#include "kernels/evolution.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "kernels/curvature.hpp"
#include "kernels/truncated_fit.hpp"

namespace semigeo::kernels {
namespace {

/// The derivatives that a patch determines, whole or not.
struct PatchEstimate {
  PatchDerivatives smoothed;
  PatchDerivatives fitted;  ///< equal to `smoothed` on flat faces
  float completeness;
  bool valid;
};

PatchEstimate estimate_whole(const Patch& patch, float step, bool curved) {
  const PatchDerivatives smoothed = convolve(patch, step);
  return {smoothed, curved ? fit(patch, step) : smoothed, 1, true};
}

PatchEstimate estimate_truncated(const Patch& patch, float step, bool curved) {
  PatchEstimate e{};
  e.completeness = patch.completeness();
  if (const auto quadratic = fit_quadratic(patch, step)) {
    e.valid = e.completeness >= kMinCompleteness;
    e.smoothed = e.fitted = *quadratic;
    if (curved && e.valid) e.fitted = fit_quartic(patch, step).value_or(*quadratic);
  }
  e.smoothed.r = paired_mean(patch);
  return e;
}

}  // namespace

EvolvedVertex evolve_vertex(const SampledSurface& surface, std::int32_t v, float step) {
  const GeodesicMesh& mesh = surface.mesh;
  EvolvedVertex result{mesh.point(v), mesh.normals[v], mesh.normals[v], 0, 0, 0};
  Patch patch;
  trace_patch(surface, v, first_edge(mesh, v), step, patch);

  const bool curved = !surface.curved.empty();
  const PatchEstimate e =
      patch.whole() ? estimate_whole(patch, step, curved) : estimate_truncated(patch, step, curved);
  const Eigen::Vector3f position = mesh.point(v) + e.smoothed.r;
  if (position.allFinite()) result.position = position;
  const Eigen::Vector3f tangents = e.smoothed.ru.cross(e.smoothed.rv);
  const float area = tangents.norm();
  if (!e.valid || !(area >= kMinTangentArea)) return result;

  const Curvature c = curved ? curvature_from_forms(e.fitted) : curvature_semigeodesic(e.fitted);
  const bool finite = std::isfinite(c.gaussian) && std::isfinite(c.mean) && std::isfinite(area) &&
                      c.normal.allFinite();
  if (!finite || c.normal.isZero(0)) return result;
  result.smoothed_normal = tangents / area;
  result.normal = c.normal;
  result.gaussian_curvature = c.gaussian;
  result.mean_curvature = c.mean;
  result.patch_completeness = e.completeness;
  return result;
}

}  // namespace semigeo::kernels
