// One patch traced, convolved and turned into curvature: what a vertex costs without threads, jobs
// or the preparation of faces.
#include "kernels/evolution/evolution.hpp"

#include <benchmark/benchmark.h>

#include "bench/support/memory.hpp"
#include "tests/support/prepared_surface.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::bench {
namespace {

void evolve_all(benchmark::State& state, kernels::TriangleMesh mesh, bool curved) {
  const kernels::PreparedSurface surface(std::move(mesh), curved);
  const auto step = static_cast<float>(kernels::mean_edge_length(surface.surface));
  const auto count = static_cast<std::int32_t>(surface.surface.vertex_count());
  for (auto _ : state)
    for (std::int32_t v = 0; v < count; ++v)
      benchmark::DoNotOptimize(kernels::evolve_vertex(surface.sampled(), v, {.step = step}));
  report_vertices(state, count);
}

void evolve_icosphere(benchmark::State& state, bool curved) {
  evolve_all(state, shapes::icosphere(6), curved);
}
BENCHMARK_CAPTURE(evolve_icosphere, curved, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(evolve_icosphere, flat, false)->Unit(benchmark::kMillisecond);

/// Edges that differ by a factor of 9: more faces to cross, and less predictable ones.
void evolve_uneven_torus(benchmark::State& state) {
  evolve_all(state, shapes::torus(1, 0.4, 320, 128, 0.8), true);
}
BENCHMARK(evolve_uneven_torus)->Unit(benchmark::kMillisecond);

/// A quarter of the patches is truncated and solved by least squares.
void evolve_rims(benchmark::State& state) {
  evolve_all(state, shapes::cylinder(1, 0.25, 960, 40), true);
}
BENCHMARK(evolve_rims)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace semigeo::bench
