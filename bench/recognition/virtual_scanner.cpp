#include "bench/recognition/virtual_scanner.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

namespace semigeo::recognition {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Pixels beside a depth jump differ by more than so many of their widths.
constexpr double kJump = 4;

/// Returns where a point is seen, in pixels from the lower left corner of the image.
Vector2d pixel_of(const Vector3d& p, const Camera& camera) {
  return {camera.focal * p.x() / -p.z() - camera.left,
          camera.focal * p.y() / -p.z() - camera.bottom};
}

/// Draws one triangle into the image.
void draw(const std::array<Vector3d, 3>& t, std::int32_t object, const Camera& camera,
          DepthImage& image) {
  const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double height = normal.dot(t[0]);
  if (height == 0) return;  // it is seen from its edge
  // A ray meets the triangle if it lies on the same side of all three planes through the eye.
  const std::array<Vector3d, 3> sides = {t[0].cross(t[1]), t[1].cross(t[2]), t[2].cross(t[0])};
  Vector2d least = pixel_of(t[0], camera), most = least;
  for (const Vector3d& p : t) {
    least = least.cwiseMin(pixel_of(p, camera));
    most = most.cwiseMax(pixel_of(p, camera));
  }
  const auto first = [](double at) {
    return std::max<std::int64_t>(0, std::llround(std::floor(at - 0.5)));
  };
  const auto last = [](double at, std::int64_t size) {
    return std::min<std::int64_t>(size - 1, std::llround(std::ceil(at)));
  };
  for (std::int64_t row = first(least.y()); row <= last(most.y(), camera.rows); ++row)
    for (std::int64_t column = first(least.x()); column <= last(most.x(), camera.columns);
         ++column) {
      const Vector3d ray = camera.ray(row, column);
      const bool inside = std::ranges::all_of(
          sides, [&](const Vector3d& side) { return side.dot(ray) * height >= 0; });
      const double depth = height / normal.dot(ray);
      if (!inside || !(depth > 0) || !std::isfinite(depth)) continue;
      const auto pixel = static_cast<std::size_t>(row * camera.columns + column);
      if (image.depth[pixel] > 0 && image.depth[pixel] <= depth) continue;
      image.depth[pixel] = depth;
      image.object[pixel] = object;
    }
}

/// Returns the depth of a neighbour behind a depth jump, if a pixel has one.
std::optional<double> depth_behind(const DepthImage& image, const Camera& camera, std::int64_t row,
                                   std::int64_t column) {
  const double depth = image.depth[static_cast<std::size_t>(row * camera.columns + column)];
  constexpr std::array<std::array<int, 2>, 4> kNeighbours = {{{0, 1}, {1, 0}, {0, -1}, {-1, 0}}};
  for (const auto& [down, right] : kNeighbours) {
    const std::int64_t r = row + down, c = column + right;
    if (r < 0 || r >= camera.rows || c < 0 || c >= camera.columns) continue;
    const double other = image.depth[static_cast<std::size_t>(r * camera.columns + c)];
    if (other > depth * (1 + kJump / camera.focal)) return other;
  }
  return std::nullopt;
}

void mix(DepthImage& image, const Camera& camera, double share, bench::Random& random) {
  const DepthImage sharp = image;
  std::uniform_real_distribution<double> chance(0.0, 1.0);
  for (std::int64_t row = 0; row < camera.rows; ++row)
    for (std::int64_t column = 0; column < camera.columns; ++column) {
      const auto pixel = static_cast<std::size_t>(row * camera.columns + column);
      if (sharp.depth[pixel] <= 0) continue;
      const std::optional<double> behind = depth_behind(sharp, camera, row, column);
      if (!behind || chance(random) >= share) continue;
      image.depth[pixel] += chance(random) * (*behind - sharp.depth[pixel]);
      image.object[pixel] = -1;
    }
}

}  // namespace

Vector3d Camera::ray(std::int64_t row, std::int64_t column) const {
  return {(left + static_cast<double>(column) + 0.5) / focal,
          (bottom + static_cast<double>(row) + 0.5) / focal, -1};
}

Camera camera_for(std::span<const Vector3d> points, std::int64_t pixels) {
  Vector2d least = Vector2d::Constant(std::numeric_limits<double>::infinity());
  Vector2d most = -least;
  for (const Vector3d& p : points) {
    const Vector2d seen = p.head<2>() / -p.z();
    least = least.cwiseMin(seen);
    most = most.cwiseMax(seen);
  }
  const Vector2d extent = most - least;
  Camera camera;
  camera.focal = static_cast<double>(pixels) / extent.maxCoeff();
  camera.left = camera.focal * least.x();
  camera.bottom = camera.focal * least.y();
  camera.columns = std::llround(std::ceil(camera.focal * extent.x()));
  camera.rows = std::llround(std::ceil(camera.focal * extent.y()));
  return camera;
}

DepthImage render(std::span<const kernels::TriangleMesh> objects, const Camera& camera) {
  const auto pixels = static_cast<std::size_t>(camera.columns * camera.rows);
  DepthImage image{.depth = std::vector<double>(pixels, 0.0),
                   .object = std::vector<std::int32_t>(pixels, -1)};
  for (std::size_t i = 0; i < objects.size(); ++i)
    for (const auto& t : objects[i].triangles)
      draw({objects[i].points[t[0]], objects[i].points[t[1]], objects[i].points[t[2]]},
           static_cast<std::int32_t>(i), camera, image);
  return image;
}

void disturb(DepthImage& image, const Camera& camera, const ScannerErrors& errors,
             bench::Random& random) {
  if (errors.mixed > 0) mix(image, camera, errors.mixed, random);
  double sum = 0;
  double met = 0;
  for (const double depth : image.depth)
    if (depth > 0) {
      sum += depth;
      met += 1;
    }
  const double quantum = met > 0 ? errors.quantum * sum / met / camera.focal : 0;
  std::normal_distribution<double> normal;
  for (double& depth : image.depth) {
    if (depth <= 0) continue;
    depth *= 1 + errors.noise * normal(random) / camera.focal;
    if (quantum > 0) depth = quantum * std::round(depth / quantum);
  }
}

VirtualScan triangulated(const DepthImage& image, const Camera& camera) {
  VirtualScan scan;
  kernels::RangeGrid grid{.rows = camera.rows,
                          .columns = camera.columns,
                          .cells = std::vector<std::int32_t>(image.depth.size(), -1),
                          .eye = Vector3d::Zero()};
  for (std::int64_t row = 0; row < camera.rows; ++row)
    for (std::int64_t column = 0; column < camera.columns; ++column) {
      const auto pixel = static_cast<std::size_t>(row * camera.columns + column);
      if (image.depth[pixel] <= 0) continue;
      grid.cells[pixel] = static_cast<std::int32_t>(scan.mesh.points.size());
      scan.mesh.points.push_back(image.depth[pixel] * camera.ray(row, column));
      scan.object.push_back(image.object[pixel]);
    }
  scan.mesh.triangles = kernels::triangulate_grid(grid, scan.mesh.points).triangles;
  return scan;
}

std::vector<double> areas_of_objects(const VirtualScan& scan, std::size_t objects) {
  std::vector<double> areas(objects, 0.0);
  for (const auto& t : scan.mesh.triangles) {
    const std::int32_t object = scan.object[t[0]];
    if (object < 0 || scan.object[t[1]] != object || scan.object[t[2]] != object) continue;
    const Vector3d& a = scan.mesh.points[t[0]];
    areas[object] += (scan.mesh.points[t[1]] - a).cross(scan.mesh.points[t[2]] - a).norm() / 2;
  }
  return areas;
}

}  // namespace semigeo::recognition
