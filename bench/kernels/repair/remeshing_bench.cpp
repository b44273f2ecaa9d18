// Ridding a noisy mesh of its short edges, cutting a mesh down by them, and refining one.
#include "kernels/repair/remeshing.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
#include <utility>
#include <vector>

#include "bench/support/memory.hpp"
#include "bench/support/scans.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::bench {
namespace {

constexpr int kSubdivisions = 7;

/// A sphere whose vertices are moved by noise of `noise` mean edge lengths.
kernels::LevelMesh rough_sphere(double noise) {
  kernels::TriangleMesh sphere = shapes::icosphere(kSubdivisions);
  const double edge = kernels::mean_edge_length(prepared(sphere));
  shapes::add_noise(sphere, noise * edge, 1);
  kernels::LevelMesh mesh;
  kernels::Surface surface = prepared(std::move(sphere));
  for (const Eigen::Vector3f& p : surface.points) {
    mesh.points.emplace_back(p.x(), p.y(), p.z(), 0.0f);
    mesh.normals.push_back(p.normalized());
    mesh.source.push_back(static_cast<std::int32_t>(mesh.source.size()));
  }
  mesh.initial_points = std::move(surface.points);
  mesh.part = std::move(surface.part);
  mesh.part_count = surface.part_count;
  mesh.connectivity = std::move(surface);
  return mesh;
}

double mean_edge(const kernels::LevelMesh& mesh) {
  double sum = 0;
  for (std::int32_t f = 0; f < mesh.connectivity.face_count(); ++f)
    for (int i = 0; i < 3; ++i) sum += std::sqrt(mesh.length2(kernels::halfedge(f, i)));
  return sum / (3 * static_cast<double>(mesh.connectivity.face_count()));
}

/// Removes what is below `shortest` mean edge lengths; if `refine`, splits the longest
/// edges until there are as many faces as before.
void remesh(benchmark::State& state, double shortest, bool refine) {
  const kernels::LevelMesh rough = rough_sphere(0.3);
  const double edge = mean_edge(rough);
  const auto faces = static_cast<std::int32_t>(rough.connectivity.face_count());
  kernels::RemeshCounts counts;
  for (auto _ : state) {
    state.PauseTiming();
    kernels::LevelMesh mesh = rough;
    state.ResumeTiming();
    std::vector<std::int32_t> odd;
    kernels::find_odd_faces(mesh, 0, faces, shortest * edge, odd);
    kernels::Remesher remesher(mesh, true);
    remesher.remove_odd(odd, shortest * edge);
    if (refine) {
      std::vector<std::int32_t> edges;
      kernels::find_long_edges(mesh, 0, static_cast<std::int32_t>(mesh.connectivity.face_count()),
                               edge, edges);
      remesher.refine(edges, faces, edge, 2 * shortest * edge);
    }
    counts = remesher.finish();
    state.PauseTiming();
    mesh = {};
    state.ResumeTiming();
  }
  report_vertices(state, rough.vertex_count());
  state.counters["flipped"] = static_cast<double>(counts.flipped);
  state.counters["collapsed"] = static_cast<double>(counts.collapsed);
  state.counters["split"] = static_cast<double>(counts.split);
}

/// What a level costs: few edges, and the passes over the whole mesh.
void remesh_level(benchmark::State& state) {
  remesh(state, 0.1, true);
}
BENCHMARK(remesh_level)->Unit(benchmark::kMillisecond);

/// Dominated by the edits.
void collapse_half(benchmark::State& state) {
  remesh(state, 1.0, false);
}
BENCHMARK(collapse_half)->Unit(benchmark::kMillisecond);

void find_odd_faces(benchmark::State& state) {
  const kernels::LevelMesh mesh = rough_sphere(0.3);
  const double edge = mean_edge(mesh);
  std::vector<std::int32_t> odd;
  for (auto _ : state) {
    odd.clear();
    kernels::find_odd_faces(mesh, 0, static_cast<std::int32_t>(mesh.connectivity.face_count()),
                            0.1 * edge, odd);
    benchmark::DoNotOptimize(odd.data());
  }
  report_vertices(state, mesh.vertex_count());
}
BENCHMARK(find_odd_faces)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace semigeo::bench
