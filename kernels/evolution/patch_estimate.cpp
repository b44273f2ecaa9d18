#include "kernels/evolution/patch_estimate.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "kernels/evolution/curvature.hpp"
#include "kernels/patch/truncated_fit.hpp"

namespace semigeo::kernels {
namespace {

/// `samples` are those of the patch, in any form that the fits take.
template <typename AnyPatch, typename Samples>
PatchEstimate estimate_truncated(const AnyPatch& patch, const Samples& samples, float step) {
  PatchEstimate e{};
  e.moved = patch.paired_mean();
  e.completeness = patch.completeness();
  if (const auto quadratic = fit_quadratic(samples, step)) {
    e.valid = e.completeness >= kMinCompleteness;
    e.smoothed = *quadratic;
    e.fitted = e.valid ? fit_quartic(samples, step).value_or(*quadratic) : *quadratic;
  }
  return e;
}

}  // namespace

PatchEstimate estimate(const Patch& patch, float step) {
  if (!patch.whole()) return estimate_truncated(patch, patch, step);
  const PatchDerivatives smoothed = convolve(patch, step);
  return {smoothed.r, smoothed, fit(patch, step), 1, true};
}

PatchEstimate estimate(const PolarPatch& patch, float step) {
  if (!patch.whole()) return estimate_truncated(patch, patch.samples(), step);
  return {patch.paired_mean(), convolve_tangents(patch, step), fit(patch, step), 1, true};
}

EvolvedVertex evolved_vertex(const SampledSurface& surface, std::int32_t v,
                             const PatchLayout& layout, const PatchEstimate& estimate) {
  const GeodesicMesh& mesh = surface.mesh;
  EvolvedVertex result{mesh.point(v), mesh.normals[v], mesh.normals[v], 0, 0, 0, {}};
  const Eigen::Vector3f position = mesh.point(v) + estimate.moved;
  if (position.allFinite()) result.position = position;
  const Eigen::Vector3f tangents = estimate.smoothed.ru.cross(estimate.smoothed.rv);
  const float area = tangents.norm();
  if (!estimate.valid || !(area >= kMinTangentArea)) return result;

  const bool as_thesis = layout.coordinates == Coordinates::kSemigeodesic && surface.curved.empty();
  const Curvature c =
      as_thesis ? curvature_semigeodesic(estimate.fitted) : curvature_from_forms(estimate.fitted);
  const bool finite = std::isfinite(c.gaussian) && std::isfinite(c.mean) && std::isfinite(area) &&
                      c.normal.allFinite();
  if (!finite || c.normal.isZero(0)) return result;
  result.smoothed_normal = tangents / area;
  result.normal = c.normal;
  result.gaussian_curvature = c.gaussian;
  result.mean_curvature = c.mean;
  result.patch_completeness = estimate.completeness;
  if (layout.principal) {
    const PrincipalCurvatures p = principal_curvatures(estimate.fitted);
    if (p.first.allFinite() && p.second.allFinite() && std::isfinite(p.k1) && std::isfinite(p.k2))
      result.principal = p;
  }
  return result;
}

}  // namespace semigeo::kernels
