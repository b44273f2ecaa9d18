#include "kernels/evolution/evolution.hpp"

#include "kernels/evolution/patch_estimate.hpp"

namespace semigeo::kernels {
namespace {

PatchEstimate semigeodesic_estimate(const SampledSurface& surface, std::int32_t v,
                                    std::int32_t first, float step) {
  Patch patch;
  trace_patch(surface, v, first, step, patch);
  return estimate(patch, step);
}

PatchEstimate polar_estimate(const SampledSurface& surface, std::int32_t v, std::int32_t first,
                             float step) {
  PolarPatch patch;
  trace_polar_patch(surface, v, first, step, patch);
  return estimate(patch, step);
}

}  // namespace

EvolvedVertex evolve_vertex(const SampledSurface& surface, std::int32_t v,
                            const PatchLayout& layout) {
  const std::int32_t first = layout.first == kNone ? first_edge(surface.mesh, v) : layout.first;
  const PatchEstimate estimate = layout.coordinates == Coordinates::kSemigeodesic
                                     ? semigeodesic_estimate(surface, v, first, layout.step)
                                     : polar_estimate(surface, v, first, layout.step);
  return evolved_vertex(surface, v, layout, estimate);
}

}  // namespace semigeo::kernels
