// The whole job: from the scan's file to the verified dataset, eight smoothings, default options.
#include "jobs/stages/surface_job.hpp"

#include <benchmark/benchmark.h>

#include <vector>

#include "bench/support/memory.hpp"
#include "bench/support/scans.hpp"
#include "io/files/file_digest.hpp"
#include "io/scans/mesh_writer.hpp"
#include "jobs/kinds/surface.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::bench {
namespace {

namespace fs = std::filesystem;

void run(benchmark::State& state, const fs::path& input, const fs::path& output, int threads) {
  engine::Workers workers(threads);
  engine::Observer observer;
  const jobs::SurfaceParameters parameters;
  jobs::SurfaceJob job;
  job.input = input;
  job.name = input.filename().string();
  job.output = output;
  job.input_xxh3 = io::xxh3_of_file(input);
  job.key = jobs::surface_key(job.name, job.input_xxh3, to_json(parameters));
  jobs::SurfaceJobResult result;
  const PeakMemory memory;
  for (auto _ : state) result = jobs::run_surface_job(job, parameters, {workers, observer, {}});
  state.SetLabel(std::to_string(result.vertices) + " vertices");
  report_vertices(state, result.vertices * result.levels);
  report_memory(state, memory, result.vertices);
}

void write_icosphere(const fs::path& path, int subdivisions) {
  const kernels::TriangleMesh mesh = shapes::icosphere(subdivisions);
  std::vector<float> points;
  for (const auto& p : mesh.points)
    for (int c = 0; c < 3; ++c) points.push_back(static_cast<float>(p[c]));
  std::vector<std::int64_t> triangles;
  for (const auto& t : mesh.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
  io::write_ply(path, {.points = points, .normals = {}, .triangles = triangles, .scalars = {}});
}

void surface_job_icosphere(benchmark::State& state) {
  const tests::TemporaryFolder folder;
  write_icosphere(folder / "sphere.ply", static_cast<int>(state.range(0)));
  run(state, folder / "sphere.ply", folder / "sphere.ply.vtkhdf", static_cast<int>(state.range(1)));
}
BENCHMARK(surface_job_icosphere)
    ->ArgNames({"subdivisions", "threads"})
    ->ArgsProduct({{5, 7, 8}, {1, 2}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

void surface_job_real_scan(benchmark::State& state) {
  const auto path = real_scan();
  if (path.empty()) return state.SkipWithError("no scan: set SEMIGEO_BENCH_SCAN");
  const tests::TemporaryFolder folder;
  run(state, path, folder / "scan.vtkhdf", static_cast<int>(state.range(0)));
}
BENCHMARK(surface_job_real_scan)
    ->ArgNames({"threads"})
    ->Arg(1)
    ->Arg(2)
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace semigeo::bench
