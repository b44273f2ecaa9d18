// From a list of triangles to a connected surface, and its reordering for locality.
#include "kernels/repair/surface_builder.hpp"

#include <benchmark/benchmark.h>

#include "bench/support/memory.hpp"
#include "bench/support/scans.hpp"
#include "kernels/surface/vertex_order.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::bench {
namespace {

constexpr int kSubdivisions = 7;

/// Three points of its own for every triangle, as STL has them.
kernels::TriangleMesh soup(const kernels::TriangleMesh& mesh) {
  kernels::TriangleMesh result;
  for (const auto& t : mesh.triangles) {
    const auto first = static_cast<std::int32_t>(result.points.size());
    for (const std::int32_t v : t) result.points.push_back(mesh.points[v]);
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

void build(benchmark::State& state, const kernels::TriangleMesh& mesh) {
  const std::int64_t vertices = icosphere_vertices(kSubdivisions);
  const PeakMemory memory;
  for (auto _ : state) {
    state.PauseTiming();
    kernels::TriangleMesh copy = mesh;
    state.ResumeTiming();
    benchmark::DoNotOptimize(kernels::build_surface(std::move(copy)));
  }
  report_vertices(state, vertices);
  report_memory(state, memory, vertices);
}

void build_surface_indexed(benchmark::State& state) {
  build(state, shapes::icosphere(kSubdivisions));
}
BENCHMARK(build_surface_indexed)->Unit(benchmark::kMillisecond);

void build_surface_soup(benchmark::State& state) {
  build(state, soup(shapes::icosphere(kSubdivisions)));
}
BENCHMARK(build_surface_soup)->Unit(benchmark::kMillisecond);

void reorder_for_locality(benchmark::State& state) {
  const auto surface = kernels::build_surface(shapes::icosphere(kSubdivisions)).surface;
  for (auto _ : state)
    benchmark::DoNotOptimize(kernels::reordered(surface, kernels::locality_order(surface)));
  report_vertices(state, surface.vertex_count());
}
BENCHMARK(reorder_for_locality)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace semigeo::bench
