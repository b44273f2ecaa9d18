// Decimation to half the vertices and to a tolerance; distances from a surface.
#include "kernels/repair/decimation.hpp"

#include <benchmark/benchmark.h>

#include "bench/support/memory.hpp"
#include "bench/support/scans.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::bench {
namespace {

constexpr int kSubdivisions = 7;

kernels::Surface sphere() {
  return prepared(shapes::icosphere(kSubdivisions));
}

void decimate(benchmark::State& state, const kernels::DecimationOptions& options) {
  const kernels::Surface surface = sphere();
  const PeakMemory memory;
  std::int64_t left = 0;
  for (auto _ : state) left = kernels::decimate(surface, options).surface.vertex_count();
  report_vertices(state, surface.vertex_count());
  report_memory(state, memory, surface.vertex_count());
  state.counters["left"] = static_cast<double>(left);
}

void decimate_to_half(benchmark::State& state) {
  decimate(state, {.target_vertices = icosphere_vertices(kSubdivisions) / 2,
                   .measure = state.range(0) != 0});
}
BENCHMARK(decimate_to_half)->ArgName("measure")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void decimate_to_tolerance(benchmark::State& state) {
  decimate(state, {.tolerance = 1e-4, .measure = false});
}
BENCHMARK(decimate_to_tolerance)->Unit(benchmark::kMillisecond);

void build_nearest_surface(benchmark::State& state) {
  const kernels::Surface surface = sphere();
  for (auto _ : state) benchmark::DoNotOptimize(kernels::NearestSurface(surface));
  report_vertices(state, surface.vertex_count());
}
BENCHMARK(build_nearest_surface)->Unit(benchmark::kMillisecond);

void nearest_point(benchmark::State& state) {
  const kernels::Surface coarse = prepared(shapes::icosphere(kSubdivisions - 1));
  const kernels::Surface fine = sphere();
  const kernels::NearestSurface nearest(coarse);
  for (auto _ : state) benchmark::DoNotOptimize(kernels::distances(nearest, fine.points));
  report_vertices(state, fine.vertex_count());
}
BENCHMARK(nearest_point)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace semigeo::bench
