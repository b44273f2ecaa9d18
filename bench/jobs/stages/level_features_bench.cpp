// What features add to a level: `evaluate` and `move` beside `find_features`, in one run, so that
// the ratio holds on a busy machine.
#include "jobs/stages/level_features.hpp"

#include <benchmark/benchmark.h>

#include "bench/support/memory.hpp"
#include "bench/support/scans.hpp"
#include "engine/stopwatch.hpp"
#include "io/scans/scan_reader.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::bench {
namespace {

constexpr int kLevels = 8;

/// Adds up what the stages take.
class Times : public engine::Observer {
 public:
  void timed(std::string_view stretch, double seconds, double) override {
    if (stretch == "features") features += seconds;
    if (stretch == "level") level += seconds;
  }
  double features = 0;
  double level = 0;
};

void level_features(benchmark::State& state, kernels::TriangleMesh mesh, int threads) {
  engine::Workers workers(threads);
  Times times;
  const engine::RunContext context{workers, times, {}};
  kernels::Surface surface = prepared(std::move(mesh));
  mesh = {};
  const std::int64_t vertices = surface.vertex_count();
  jobs::EvolvingSurface evolving(std::move(surface), {}, context);
  std::size_t features = 0;
  for (auto _ : state) {
    jobs::LevelFields fields;
    {
      const engine::Stopwatch stopwatch(times, "level");
      fields = evolving.evaluate();
    }
    {
      const engine::Stopwatch stopwatch(times, "features");
      const kernels::LevelFeatures found = jobs::find_features(evolving, fields, {}, context);
      for (const auto& kind : found.of_kind) features += kind.size();
    }
    const engine::Stopwatch stopwatch(times, "level");
    evolving.move();
  }
  state.SetLabel(std::to_string(vertices) + " vertices");
  state.counters["features"] = static_cast<double>(features) / kLevels;
  state.counters["share"] = times.features / times.level;
  report_vertices(state, vertices);
}

void level_features_noisy_torus(benchmark::State& state) {
  kernels::TriangleMesh torus = shapes::torus(1, 0.4, 600, 240, 0.3);
  shapes::add_noise(torus, 0.3 * 2.5 / 600 * 2, 1);
  level_features(state, std::move(torus), static_cast<int>(state.range(0)));
}

void level_features_icosphere(benchmark::State& state) {
  level_features(state, shapes::icosphere(7), static_cast<int>(state.range(0)));
}

void level_features_real_scan(benchmark::State& state) {
  const auto path = real_scan();
  if (path.empty()) return state.SkipWithError("no scan: set SEMIGEO_BENCH_SCAN");
  level_features(state, io::read_scan(path).mesh, static_cast<int>(state.range(0)));
}

void on_one_and_two_threads(benchmark::internal::Benchmark* bench) {
  bench->ArgName("threads")->Arg(1)->Arg(2)->Iterations(kLevels);
  bench->Unit(benchmark::kMillisecond)->UseRealTime();
}
BENCHMARK(level_features_icosphere)->Apply(on_one_and_two_threads);
BENCHMARK(level_features_noisy_torus)->Apply(on_one_and_two_threads);
BENCHMARK(level_features_real_scan)->Apply(on_one_and_two_threads);

}  // namespace
}  // namespace semigeo::bench
