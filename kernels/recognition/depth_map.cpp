#include "kernels/recognition/depth_map.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace semigeo::kernels {
namespace {

using Eigen::Vector3f;

/// The width of a cell, in spacings of the samples at their median distance.
constexpr float kCellWidth = 1.2F;
/// The tangent of the largest angle of a ray with the axis of the map.
constexpr float kWidest = 1.75F;
/// The largest number of cells along a side. A map of a few samples far apart is coarser.
constexpr float kMostCells = 2000;
/// Nearer samples are farther apart in the map, so more cells are looked at, up to so many on each
/// side.
constexpr float kFarthestCell = 3;

Vector3f mean_direction(const SurfaceSamples& scene, const Vector3f& eye) {
  Vector3f sum = Vector3f::Zero();
  for (const Vector3f& p : scene.points) sum += (p - eye).normalized();
  return sum.normalized();
}

}  // namespace

DepthMap::DepthMap(const SurfaceSamples& scene, const Eigen::Vector3d& eye)
    : eye_(eye.cast<float>()) {
  if (scene.points.empty()) return;
  frame_ = Eigen::Quaternionf::FromTwoVectors(mean_direction(scene, eye_), Vector3f::UnitZ())
               .toRotationMatrix();
  std::vector<Ray> rays;
  rays.reserve(scene.points.size());
  for (const Vector3f& p : scene.points)
    if (const Ray ray = ray_to(p); ray.distance >= 0) rays.push_back(ray);
  if (rays.empty()) return;
  Eigen::AlignedBox2f box;
  for (const Ray& ray : rays) box.extend(Eigen::Vector2f(ray.u, ray.v));
  const auto middle = rays.begin() + std::ssize(rays) / 2;
  std::ranges::nth_element(rays, middle, {}, &Ray::distance);
  usual_ = middle->distance;
  const float extent = std::max(box.sizes().maxCoeff(), std::numeric_limits<float>::min());
  cells_ = std::min(usual_ / (kCellWidth * scene.spacing), kMostCells / extent);
  left_ = box.min().x();
  bottom_ = box.min().y();
  columns_ = static_cast<std::int64_t>(cells_ * box.sizes().x()) + 1;
  rows_ = static_cast<std::int64_t>(cells_ * box.sizes().y()) + 1;
  place(rays);
}

Sight DepthMap::look(const Vector3f& p, float tolerance) const {
  const Ray ray = ray_to(p);
  if (ray.distance < 0) return Sight::kUnmapped;
  const std::int64_t reach =
      std::llround(std::clamp(usual_ / std::max(ray.distance, tolerance), 1.0F, kFarthestCell));
  const std::int64_t column = column_of(ray);
  const std::int64_t row = row_of(ray);
  bool behind = false;
  bool in_front = false;
  for (auto r = std::max<std::int64_t>(row - reach, 0); r <= std::min(row + reach, rows_ - 1); ++r)
    for (auto c = std::max<std::int64_t>(column - reach, 0);
         c <= std::min(column + reach, columns_ - 1); ++c) {
      const std::int64_t cell = r * columns_ + c;
      for (std::int32_t i = first_[cell]; i < first_[cell + 1]; ++i) {
        const float beyond = distances_[i] - ray.distance;
        if (std::abs(beyond) <= tolerance) return Sight::kThere;
        (beyond > 0 ? behind : in_front) = true;
      }
    }
  if (in_front) return Sight::kInFront;
  return behind ? Sight::kBehind : Sight::kNothing;
}

DepthMap::Ray DepthMap::ray_to(const Vector3f& p) const {
  const Vector3f seen = frame_ * (p - eye_);
  const float aside = seen.head<2>().norm();
  if (!(seen.z() > 0) || aside > kWidest * seen.z()) return {0, 0, -1};
  return {seen.x() / seen.z(), seen.y() / seen.z(), seen.norm()};
}

std::int64_t DepthMap::column_of(const Ray& ray) const {
  return static_cast<std::int64_t>(std::floor(cells_ * (ray.u - left_)));
}

std::int64_t DepthMap::row_of(const Ray& ray) const {
  return static_cast<std::int64_t>(std::floor(cells_ * (ray.v - bottom_)));
}

/// Puts the distances of rays into their cells.
void DepthMap::place(const std::vector<Ray>& rays) {
  const auto cell_of = [&](const Ray& ray) {
    return std::clamp<std::int64_t>(row_of(ray), 0, rows_ - 1) * columns_ +
           std::clamp<std::int64_t>(column_of(ray), 0, columns_ - 1);
  };
  first_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  for (const Ray& ray : rays) ++first_[cell_of(ray) + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
  distances_.resize(rays.size());
  for (const Ray& ray : rays) distances_[next[cell_of(ray)]++] = ray.distance;
}

}  // namespace semigeo::kernels
