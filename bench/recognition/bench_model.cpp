#include "bench/recognition/bench_model.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <stdexcept>
#include <utility>

#include "bench/support/chance.hpp"
#include "bench/support/mesh_changes.hpp"
#include "bench/support/quadric_decimation.hpp"
#include "io/files/error.hpp"
#include "io/scans/scan_reader.hpp"
#include "kernels/surface/bounding_box.hpp"

namespace semigeo::recognition {
namespace {

namespace fs = std::filesystem;

bool is_closed(const kernels::Surface& surface) {
  for (std::int32_t v = 0; v < surface.vertex_count(); ++v)
    if (surface.on_boundary(v)) return false;
  return true;
}

std::vector<fs::path> scan_files(const std::vector<fs::path>& places) {
  std::vector<fs::path> files;
  for (const fs::path& place : places) {
    if (!fs::is_directory(place)) {
      files.push_back(place);
      continue;
    }
    std::vector<fs::path> found;
    for (const auto& entry : fs::recursive_directory_iterator(place))
      if (entry.is_regular_file() && io::is_scan_name(entry.path())) found.push_back(entry.path());
    std::ranges::sort(found);
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

kernels::TriangleMesh file_mesh(const kernels::BuiltSurface& built) {
  kernels::TriangleMesh mesh = bench::triangle_mesh(built.surface);
  for (Eigen::Vector3d& p : mesh.points) p += built.origin;
  return mesh;
}

kernels::TriangleMesh decimated(const kernels::TriangleMesh& mesh, std::int64_t most_vertices) {
  if (most_vertices <= 0 || std::ssize(mesh.points) <= most_vertices) return mesh;
  return bench::quadric_decimated(mesh, most_vertices);
}

std::string stem_of(fs::path path) {
  if (path.extension() == ".gz") path = path.stem();
  return path.stem().string();
}

}  // namespace

double size_in_heaps(const std::string& name) {
  constexpr double kSpread = 1.3;
  bench::Random random = bench::random(0, 0, name);
  return std::pow(kSpread, std::uniform_real_distribution(-1.0, 1.0)(random));
}

kernels::TriangleMesh repaired(kernels::TriangleMesh mesh, std::int64_t most_vertices) {
  return decimated(file_mesh(kernels::build_surface(std::move(mesh))), most_vertices);
}

std::unique_ptr<BenchModel> make_model(std::string name, kernels::TriangleMesh mesh,
                                       std::int64_t most_vertices) {
  auto model = std::make_unique<BenchModel>();
  model->name = std::move(name);
  model->fine = repaired(std::move(mesh), 0);
  model->built = kernels::build_surface(decimated(model->fine, most_vertices));
  if (model->built.surface.face_count() == 0) return nullptr;
  model->mesh = file_mesh(model->built);
  const Eigen::AlignedBox3d box = kernels::bounding_box(model->mesh.points);
  model->centre = box.center();
  model->diagonal = box.diagonal().norm();
  model->nearest = std::make_unique<kernels::NearestSurface>(model->built.surface);
  return model;
}

BenchModels read_models(const ModelChoice& choice, std::vector<SkippedModel>& skipped) {
  BenchModels models;
  std::map<std::string, int> stems;
  for (const fs::path& path : scan_files(choice.places)) {
    if (choice.most_models > 0 && std::ssize(models) >= choice.most_models) break;
    try {
      kernels::TriangleMesh mesh = io::read_scan(path).mesh;
      if (!is_closed(kernels::build_surface(kernels::TriangleMesh(mesh)).surface)) {
        skipped.push_back({path, "it has a boundary"});
        continue;
      }
      std::string name = stem_of(path);
      if (const int again = stems[name]++; again > 0) name += "_" + std::to_string(again + 1);
      if (choice.as_in_heaps) {
        const double size = kernels::bounding_box(mesh.points).diagonal().norm();
        bench::move(mesh, {.scale = size_in_heaps(name) / size});
      }
      auto model = make_model(std::move(name), std::move(mesh), choice.most_vertices);
      if (model)
        models.push_back(std::move(model));
      else
        skipped.push_back({path, "no face is left after repair"});
    } catch (const std::runtime_error& e) {
      skipped.push_back({path, e.what()});
    }
  }
  return models;
}

}  // namespace semigeo::recognition
