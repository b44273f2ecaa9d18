#include "jobs/report/shown_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "io/files/base64.hpp"
#include "jobs/picture/read_triangles.hpp"
#include "kernels/repair/coarsening.hpp"
#include "kernels/repair/decimation.hpp"
#include "kernels/repair/remeshing.hpp"
#include "kernels/surface/vertex_rows.hpp"

namespace semigeo::jobs {

using Eigen::Vector3f;

ShownSurface read_shown_surface(const io::Dataset& dataset, int level) {
  ShownSurface shown;
  const std::vector<float> points = dataset.read_floats(level, "points");
  for (std::size_t i = 0; i < points.size(); i += 3)
    shown.points.emplace_back(points[i], points[i + 1], points[i + 2]);
  const std::vector<std::int64_t> corners = read_triangles(dataset, level, shown.points.size());
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    kernels::Triangle triangle = {};
    for (std::size_t corner = 0; corner < 3; ++corner)
      triangle[corner] = static_cast<std::int32_t>(corners[i + corner]);
    shown.triangles.push_back(triangle);
  }
  return shown;
}

kernels::Surface connected(ShownSurface shown) {
  kernels::Surface surface;
  const auto all = static_cast<std::int64_t>(shown.points.size());
  static_cast<kernels::Connectivity&>(surface) = kernels::connect(std::move(shown.triangles), all);
  surface.points = std::move(shown.points);
  surface.part_count = kernels::number_parts(surface, surface.part);
  return surface;
}

namespace {

/// Returns the normals of the vertices: the means of those of their faces, weighted by area.
std::vector<Vector3f> normals_of(const kernels::Surface& surface) {
  std::vector<Vector3f> normals(surface.points.size(), Vector3f::Zero());
  for (const kernels::Triangle& t : surface.triangles) {
    const Vector3f& a = surface.points[t[0]];
    const Vector3f normal = (surface.points[t[1]] - a).cross(surface.points[t[2]] - a);
    for (const std::int32_t corner : t) normals[corner] += normal;
  }
  for (Vector3f& normal : normals) normal.normalize();
  return normals;
}

/// Returns the surface with about this number of vertices. It is several times as fast as
/// decimation, and keeps less of the shape.
ShownSurface coarsened(ShownSurface shown, std::int64_t vertices) {
  const auto all = static_cast<double>(shown.points.size());
  kernels::Surface surface = connected(std::move(shown));
  const double length =
      kernels::mean_edge_length(surface) * std::sqrt(all / static_cast<double>(vertices));
  kernels::LevelMesh mesh;
  mesh.normals = normals_of(surface);
  mesh.part = std::move(surface.part);
  mesh.part_count = surface.part_count;
  for (const Vector3f& p : surface.points) mesh.points.emplace_back(p.x(), p.y(), p.z(), 0.0f);
  mesh.initial_points = std::move(surface.points);
  mesh.source.resize(mesh.points.size());
  std::iota(mesh.source.begin(), mesh.source.end(), 0);
  mesh.connectivity = std::move(static_cast<kernels::Connectivity&>(surface));
  kernels::coarsen(mesh, std::vector<double>(mesh.part_count, length));
  ShownSurface result{.points = {}, .triangles = std::move(mesh.connectivity.triangles)};
  for (const Eigen::Vector4f& p : mesh.points) result.points.push_back(p.head<3>());
  result.rows = std::move(mesh.source);
  return result;
}

}  // namespace

ShownSurface decimated(ShownSurface shown, std::int64_t vertices) {
  constexpr std::int64_t kCoarsened = 4;
  if (std::ssize(shown.points) <= vertices) return shown;
  if (std::ssize(shown.points) > 2 * kCoarsened * vertices)
    shown = coarsened(std::move(shown), kCoarsened * vertices);
  const std::vector<std::int32_t> rows = std::move(shown.rows);
  kernels::DecimatedSurface small = kernels::decimate(
      connected(std::move(shown)), {.target_vertices = vertices, .measure = false});
  return {.points = std::move(small.surface.points),
          .triangles = std::move(small.surface.triangles),
          .rows = rows.empty() ? std::move(small.source_vertex)
                               : kernels::gathered(rows, small.source_vertex)};
}

ShownBox box_of(const std::vector<Vector3f>& points) {
  ShownBox box;
  if (points.empty()) return box;
  Vector3f high = points.front();
  box.low = points.front();
  for (const Vector3f& p : points) {
    box.low = box.low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  box.size = (high - box.low).maxCoeff();
  return box;
}

std::vector<std::uint16_t> fractions(const std::vector<Vector3f>& points, const ShownBox& box) {
  static constexpr float kMost = std::numeric_limits<std::uint16_t>::max();
  const float scale = box.size > 0 ? kMost / box.size : 0;
  // The low bound also has what is not a number.
  const auto bounded = [](float x) { return x > 0 ? std::min(x, kMost) : 0.0f; };
  std::vector<std::uint16_t> result;
  for (const Vector3f& p : points)
    for (const float x : (scale * (p - box.low)).eval())
      result.push_back(static_cast<std::uint16_t>(bounded(x + 0.5f)));
  return result;
}

void add_surface(nlohmann::json& json, const ShownSurface& surface, const ShownBox& box) {
  json["low"] = {box.low.x(), box.low.y(), box.low.z()};
  json["size"] = box.size;
  json["shown_vertices"] = surface.points.size();
  json["points"] = io::base64_of(fractions(surface.points, box));
  if (!surface.rows.empty()) json["rows"] = io::base64_of(surface.rows);
  std::vector<std::uint16_t> corners;
  for (const kernels::Triangle& triangle : surface.triangles)
    for (const std::int32_t corner : triangle)
      corners.push_back(static_cast<std::uint16_t>(corner));
  json["triangles"] = io::base64_of(corners);
}

}  // namespace semigeo::jobs
