// The inner loop of the main job: patch, curvature, smoothing, rescaling and the preparation of the
// next level's faces, per vertex and level.
#include "jobs/stages/evolving_surface.hpp"

#include <benchmark/benchmark.h>

#include "bench/support/memory.hpp"
#include "bench/support/scans.hpp"
#include "io/scans/scan_reader.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::bench {
namespace {

constexpr int kLevels = 4;

void advance(benchmark::State& state, kernels::TriangleMesh mesh, int threads) {
  engine::Workers workers(threads);
  engine::Observer observer;
  kernels::Surface surface = prepared(std::move(mesh));
  mesh = {};
  const std::int64_t vertices = surface.vertex_count();
  const PeakMemory memory;
  jobs::EvolvingSurface evolving(std::move(surface), {}, {workers, observer, {}});
  for (auto _ : state) benchmark::DoNotOptimize(evolving.advance(true));
  state.SetLabel(std::to_string(vertices) + " vertices");
  report_vertices(state, vertices);
  report_memory(state, memory, vertices);
}

void advance_icosphere(benchmark::State& state) {
  advance(state, shapes::icosphere(static_cast<int>(state.range(0))),
          static_cast<int>(state.range(1)));
}
BENCHMARK(advance_icosphere)
    ->ArgNames({"subdivisions", "threads"})
    ->ArgsProduct({{5, 7, 8}, {1, 2}})
    ->Iterations(kLevels)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

void advance_real_scan(benchmark::State& state) {
  const auto path = real_scan();
  if (path.empty()) return state.SkipWithError("no scan: set SEMIGEO_BENCH_SCAN");
  advance(state, io::read_scan(path).mesh, static_cast<int>(state.range(0)));
}
BENCHMARK(advance_real_scan)
    ->ArgNames({"threads"})
    ->Arg(1)
    ->Arg(2)
    ->Iterations(kLevels)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace semigeo::bench
