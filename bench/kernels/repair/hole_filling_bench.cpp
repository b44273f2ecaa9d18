// Holes of many sizes in a sphere: splitting alone, and with refinement and fairing.
#include "kernels/repair/hole_filling.hpp"

#include <benchmark/benchmark.h>

#include <cmath>

#include "bench/support/memory.hpp"
#include "kernels/repair/surface_builder.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::bench {
namespace {

/// A sphere of 40,962 vertices without a cap; `percent` of the radius is the hole's.
kernels::Surface open_sphere(std::int64_t percent) {
  kernels::TriangleMesh mesh = shapes::icosphere(6);
  const double rim = std::cos(static_cast<double>(percent) / 100);
  std::erase_if(mesh.triangles, [&](const auto& t) { return mesh.points[t[0]].z() > rim; });
  return kernels::build_surface(std::move(mesh)).surface;
}

void fill(benchmark::State& state, bool refine) {
  const kernels::Surface surface = open_sphere(state.range(0));
  const auto loops = kernels::boundary_loops(surface);
  const kernels::HolePatchOptions options{.refine = refine};
  std::size_t vertices = 0;
  for (auto _ : state)
    for (const auto& loop : loops)
      vertices = kernels::make_hole_patch(surface, loop, options).points.size();
  state.counters["loop_edges"] = static_cast<double>(loops.front().vertices.size());
  state.counters["new_vertices"] = static_cast<double>(vertices);
}

void split_hole(benchmark::State& state) {
  fill(state, false);
}
BENCHMARK(split_hole)->Arg(5)->Arg(20)->Arg(60)->Unit(benchmark::kMillisecond);

void split_and_fair_hole(benchmark::State& state) {
  fill(state, true);
}
BENCHMARK(split_and_fair_hole)->Arg(5)->Arg(20)->Arg(60)->Unit(benchmark::kMillisecond);

void find_loops(benchmark::State& state) {
  const kernels::Surface surface = open_sphere(20);
  for (auto _ : state) benchmark::DoNotOptimize(kernels::boundary_loops(surface));
  report_vertices(state, surface.vertex_count());
}
BENCHMARK(find_loops)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace semigeo::bench
