#include "kernels/evolution/evolution.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "kernels/patch/polar_patch.hpp"
#include "kernels/patch/truncated_fit.hpp"

namespace semigeo::kernels {
namespace {

/// Holds what a patch determines, whole or not.
struct PatchEstimate {
  Eigen::Vector3f moved;      ///< smoothed position, relative to the vertex
  PatchDerivatives smoothed;  ///< of the smoothed surface; only the tangents count
  PatchDerivatives fitted;    ///< of the surface itself
  float completeness;
  bool valid;
};

template <typename AnyPatch>
PatchEstimate estimate_truncated(const AnyPatch& patch, float step) {
  PatchEstimate e{};
  e.moved = patch.paired_mean();
  e.completeness = patch.completeness();
  const PatchSamples samples = patch.samples();
  if (const auto quadratic = fit_quadratic(samples, step)) {
    e.valid = e.completeness >= kMinCompleteness;
    e.smoothed = *quadratic;
    e.fitted = e.valid ? fit_quartic(samples, step).value_or(*quadratic) : *quadratic;
  }
  return e;
}

PatchEstimate estimate_semigeodesic(const SampledSurface& surface, std::int32_t v,
                                    std::int32_t first, float step) {
  Patch patch;
  trace_patch(surface, v, first, step, patch);
  if (!patch.whole()) return estimate_truncated(patch, step);
  const PatchDerivatives smoothed = convolve(patch, step);
  return {smoothed.r, smoothed, fit(patch, step), 1, true};
}

PatchEstimate estimate_polar(const SampledSurface& surface, std::int32_t v, std::int32_t first,
                             float step) {
  PolarPatch patch;
  trace_polar_patch(surface, v, first, step, patch);
  if (!patch.whole()) return estimate_truncated(patch, step);
  return {patch.paired_mean(), convolve_tangents(patch, step), fit(patch, step), 1, true};
}

}  // namespace

EvolvedVertex evolve_vertex(const SampledSurface& surface, std::int32_t v,
                            const PatchLayout& layout) {
  const GeodesicMesh& mesh = surface.mesh;
  EvolvedVertex result{mesh.point(v), mesh.normals[v], mesh.normals[v], 0, 0, 0, {}};
  const bool semigeodesic = layout.coordinates == Coordinates::kSemigeodesic;
  const std::int32_t first = layout.first == kNone ? first_edge(mesh, v) : layout.first;
  const PatchEstimate e = semigeodesic ? estimate_semigeodesic(surface, v, first, layout.step)
                                       : estimate_polar(surface, v, first, layout.step);
  const Eigen::Vector3f position = mesh.point(v) + e.moved;
  if (position.allFinite()) result.position = position;
  const Eigen::Vector3f tangents = e.smoothed.ru.cross(e.smoothed.rv);
  const float area = tangents.norm();
  if (!e.valid || !(area >= kMinTangentArea)) return result;

  const bool as_thesis = semigeodesic && surface.curved.empty();
  const Curvature c = as_thesis ? curvature_semigeodesic(e.fitted) : curvature_from_forms(e.fitted);
  const bool finite = std::isfinite(c.gaussian) && std::isfinite(c.mean) && std::isfinite(area) &&
                      c.normal.allFinite();
  if (!finite || c.normal.isZero(0)) return result;
  result.smoothed_normal = tangents / area;
  result.normal = c.normal;
  result.gaussian_curvature = c.gaussian;
  result.mean_curvature = c.mean;
  result.patch_completeness = e.completeness;
  if (layout.principal) {
    const PrincipalCurvatures p = principal_curvatures(e.fitted);
    if (p.first.allFinite() && p.second.allFinite() && std::isfinite(p.k1) && std::isfinite(p.k2))
      result.principal = p;
  }
  return result;
}

}  // namespace semigeo::kernels
