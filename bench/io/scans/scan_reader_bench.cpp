// Reading a scan of 163,842 vertices and 327,680 triangles from every format. The files are in the
// page cache.
#include "io/scans/scan_reader.hpp"

#include <benchmark/benchmark.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "bench/support/memory.hpp"
#include "io/scans/mesh_writer.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::bench {
namespace {

namespace fs = std::filesystem;
using kernels::TriangleMesh;

std::string point_text(const Eigen::Vector3d& p) {
  char text[64];
  std::snprintf(text, sizeof text, "%.7g %.7g %.7g\n", p.x(), p.y(), p.z());
  return text;
}

std::string triangle_text(const std::array<std::int32_t, 3>& t, std::int32_t base) {
  return std::to_string(t[0] + base) + ' ' + std::to_string(t[1] + base) + ' ' +
         std::to_string(t[2] + base) + '\n';
}

void write_ply_binary(const fs::path& path, const TriangleMesh& mesh) {
  std::vector<float> points;
  for (const auto& p : mesh.points)
    for (int c = 0; c < 3; ++c) points.push_back(static_cast<float>(p[c]));
  std::vector<std::int64_t> triangles;
  for (const auto& t : mesh.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
  io::write_ply(path, {.points = points, .normals = {}, .triangles = triangles, .scalars = {}});
}

void write_ply_ascii(const fs::path& path, const TriangleMesh& mesh) {
  std::ofstream out(path);
  out << "ply\nformat ascii 1.0\nelement vertex " << mesh.points.size()
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
      << mesh.triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const auto& p : mesh.points) out << point_text(p);
  for (const auto& t : mesh.triangles) out << "3 " << triangle_text(t, 0);
}

void write_obj(const fs::path& path, const TriangleMesh& mesh) {
  std::ofstream out(path);
  for (const auto& p : mesh.points) out << "v " << point_text(p);
  for (const auto& t : mesh.triangles) out << "f " << triangle_text(t, 1);
}

void write_off(const fs::path& path, const TriangleMesh& mesh) {
  std::ofstream out(path);
  out << "OFF\n" << mesh.points.size() << ' ' << mesh.triangles.size() << " 0\n";
  for (const auto& p : mesh.points) out << point_text(p);
  for (const auto& t : mesh.triangles) out << "3 " << triangle_text(t, 0);
}

void write_stl_ascii(const fs::path& path, const TriangleMesh& mesh) {
  std::ofstream out(path);
  out << "solid sphere\n";
  for (const auto& t : mesh.triangles) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const std::int32_t v : t) out << "vertex " << point_text(mesh.points[v]);
    out << "endloop\nendfacet\n";
  }
  out << "endsolid sphere\n";
}

void write_stl_binary(const fs::path& path, const TriangleMesh& mesh) {
  std::ofstream out(path, std::ios::binary);
  const auto put = [&](const auto& value) {
    out.write(reinterpret_cast<const char*>(&value), sizeof value);
  };
  put(std::array<char, 80>{});
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    put(std::array<float, 3>{});
    for (const std::int32_t v : t)
      for (int c = 0; c < 3; ++c) put(static_cast<float>(mesh.points[v][c]));
    put(std::uint16_t{0});
  }
}

void read(benchmark::State& state, const char* name,
          const std::function<void(const fs::path&, const TriangleMesh&)>& write) {
  const tests::TemporaryFolder folder;
  const fs::path path = folder / name;
  std::int64_t vertices = 0;
  {
    const TriangleMesh mesh = shapes::icosphere(7);
    vertices = static_cast<std::int64_t>(mesh.points.size());
    write(path, mesh);
  }
  const PeakMemory memory;
  for (auto _ : state) benchmark::DoNotOptimize(io::read_scan(path));
  report_vertices(state, vertices);
  report_memory(state, memory, vertices);
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(fs::file_size(path)));
}

BENCHMARK_CAPTURE(read, ply_binary, "sphere.ply", write_ply_binary)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read, ply_ascii, "sphere.ply", write_ply_ascii)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read, obj, "sphere.obj", write_obj)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read, off, "sphere.off", write_off)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read, stl_binary, "sphere.stl", write_stl_binary)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read, stl_ascii, "sphere.stl", write_stl_ascii)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace semigeo::bench
