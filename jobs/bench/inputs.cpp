#include "jobs/bench/inputs.hpp"

#include <cstdio>
#include <utility>

#include "io/files/atomic_file.hpp"
#include "io/files/file_digest.hpp"
#include "io/scans/mesh_writer.hpp"
#include "io/scans/scan_reader.hpp"
#include "jobs/bench/surfaces.hpp"
#include "jobs/stages/surface_job.hpp"
#include "kernels/repair/surface_builder.hpp"
#include "kernels/surface/vertex_order.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

/// Builds a surface and sorts it as a surface job does.
kernels::Surface built(kernels::TriangleMesh mesh) {
  const kernels::Surface surface = kernels::build_surface(std::move(mesh)).surface;
  return kernels::reordered(surface, kernels::locality_order(surface));
}

}  // namespace

BenchSizes bench_sizes(bool quick) {
  if (!quick) return {};
  return {.even_vertices = 5'000,
          .scan_vertices = 2'000,
          .large_vertices = 4'000,
          .small_vertices = 300,
          .small_scans = 4,
          .model_vertices = 600,
          .models = 3,
          .library_models = 20,
          .memory_bytes = std::int64_t{32} << 20,
          .disk_bytes = std::int64_t{4} << 20};
}

BenchInputs::BenchInputs(fs::path folder, fs::path program, fs::path scan, const BenchSizes& sizes)
    : folder_(std::move(folder)),
      program_(std::move(program)),
      scan_file_(std::move(scan)),
      sizes_(sizes) {}

const kernels::Surface& BenchInputs::even_surface() {
  if (!even_surface_) even_surface_ = built(even_sphere(sizes_.even_vertices));
  return *even_surface_;
}

const kernels::TriangleMesh& BenchInputs::scan_mesh() {
  if (!scan_mesh_)
    scan_mesh_ =
        scan_file_.empty() ? scan_like(sizes_.scan_vertices) : io::read_scan(scan_file_).mesh;
  return *scan_mesh_;
}

const kernels::Surface& BenchInputs::scan_surface() {
  if (!scan_surface_) scan_surface_ = built(scan_mesh());
  return *scan_surface_;
}

const fs::path& BenchInputs::scan_file() {
  if (scan_file_.empty()) {
    const fs::path path = folder_ / "scan.ply";
    write_mesh(path, scan_mesh());
    scan_file_ = path;
  }
  return scan_file_;
}

const fs::path& BenchInputs::large_file() {
  if (large_file_.empty()) {
    large_file_ = folder_ / "large.ply";
    write_mesh(large_file_, even_sphere(sizes_.large_vertices));
  }
  return large_file_;
}

const fs::path& BenchInputs::small_folder() {
  if (small_folder_.empty()) {
    small_folder_ = folder_ / "small";
    fs::create_directories(small_folder_);
    for (int i = 0; i < sizes_.small_scans; ++i)
      write_mesh(small_folder_ / (std::to_string(i) + ".ply"), boulder(sizes_.small_vertices, i));
  }
  return small_folder_;
}

void write_mesh(const fs::path& path, const kernels::TriangleMesh& mesh) {
  std::vector<float> points;
  for (const auto& p : mesh.points)
    for (int c = 0; c < 3; ++c) points.push_back(static_cast<float>(p[c]));
  std::vector<std::int64_t> triangles;
  for (const auto& t : mesh.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
  io::write_ply(path, {.points = points, .normals = {}, .triangles = triangles, .scalars = {}});
}

void write_obj(const fs::path& path, const kernels::TriangleMesh& mesh) {
  std::string text;
  char line[128];
  for (const auto& p : mesh.points) {
    std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", p.x(), p.y(), p.z());
    text += line;
  }
  for (const auto& t : mesh.triangles) {
    std::snprintf(line, sizeof line, "f %d %d %d\n", t[0] + 1, t[1] + 1, t[2] + 1);
    text += line;
  }
  io::write_file_atomically(path, text);
}

void write_dataset(const fs::path& scan, const fs::path& dataset, int levels,
                   const engine::RunContext& context) {
  SurfaceParameters parameters;
  parameters.levels = levels;
  run_surface_job({.input = scan,
                   .input_name = scan.filename().string(),
                   .name = scan.filename().string(),
                   .output = dataset,
                   .input_xxh3 = io::xxh3_of_file(scan),
                   .key = "bench"},
                  parameters, context);
}

}  // namespace semigeo::jobs
