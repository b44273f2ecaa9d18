// Patches of a whole level by each instruction set: what a vertex costs without threads, jobs or
// the preparation of faces. SEMIGEO_BENCH_SCAN names another real scan.
#include "kernels/lanes/evolve_vertices.hpp"

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "bench/support/memory.hpp"
#include "bench/support/scans.hpp"
#include "io/scans/scan_reader.hpp"
#include "tests/support/prepared_surface.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::bench {
namespace {

/// Vertices that one call gets, as in the surface job.
constexpr std::size_t kCall = 512;

void evolve_all(benchmark::State& state, const kernels::PreparedSurface& surface,
                kernels::InstructionSet set) {
  if (!kernels::supported(set)) {
    state.SkipWithError("this CPU does not have it");
    return;
  }
  const auto step = static_cast<float>(kernels::mean_edge_length(surface.surface));
  const kernels::SampledSurface sampled = surface.sampled();
  std::vector<std::int32_t> first(surface.points.size());
  for (std::size_t v = 0; v < first.size(); ++v)
    first[v] = kernels::first_edge(sampled.mesh, static_cast<std::int32_t>(v));
  std::vector<kernels::EvolvedVertex> results(kCall);
  for (auto _ : state)
    for (std::size_t v = 0; v < first.size(); v += kCall) {
      const std::size_t count = std::min(kCall, first.size() - v);
      kernels::evolve_vertices(sampled, {&first[v], count}, {.step = step}, set,
                               {results.data(), count});
      benchmark::DoNotOptimize(results.data());
    }
  report_vertices(state, static_cast<std::int64_t>(first.size()));
}

const kernels::PreparedSurface& icosphere() {
  static const kernels::PreparedSurface surface(shapes::icosphere(7));
  return surface;
}

/// Edges that differ by a factor of 9.
const kernels::PreparedSurface& uneven_torus() {
  static const kernels::PreparedSurface surface(shapes::torus(1, 0.4, 320, 128, 0.8));
  return surface;
}

/// A quarter of the patches is truncated and solved by least squares.
const kernels::PreparedSurface& rims() {
  static const kernels::PreparedSurface surface(shapes::cylinder(1, 0.25, 960, 40));
  return surface;
}

const kernels::PreparedSurface& scan() {
  static const kernels::PreparedSurface surface(io::read_scan(real_scan()).mesh);
  return surface;
}

const bool registered = [] {
  struct Case {
    std::string name;
    const kernels::PreparedSurface& (*surface)();
  };
  for (const Case& c : {Case{"icosphere", icosphere}, Case{"uneven_torus", uneven_torus},
                        Case{"rims", rims}, Case{"real_scan", scan}})
    for (const kernels::InstructionSet set : kernels::kInstructionSets)
      benchmark::RegisterBenchmark(
          ("evolve_vertices/" + c.name + "/" + std::string(name_of(set))).c_str(),
          [=](benchmark::State& state) {
            if (c.surface == scan && real_scan().empty())
              state.SkipWithError("no scan; SEMIGEO_BENCH_SCAN can name one");
            else
              evolve_all(state, c.surface(), set);
          })
          ->Unit(benchmark::kMillisecond);
  return true;
}();

}  // namespace
}  // namespace semigeo::bench
