#include "kernels/recognition/single_view.hpp"

#include <algorithm>

namespace semigeo::kernels {
namespace {

using Eigen::Vector3d;

/// The least share of the normals that face the eye.
constexpr double kLeastFacing = 0.99;
/// The distance of an eye of which only the direction is known, in diagonals of the scene.
constexpr double kFarAway = 100;

bool is_faced(const SurfaceSamples& samples, const Vector3d& eye) {
  std::size_t facing = 0;
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    const Vector3d to_eye = eye - samples.points[i].cast<double>();
    facing += samples.normals[i].cast<double>().dot(to_eye) > 0 ? 1 : 0;
  }
  return static_cast<double>(facing) >= kLeastFacing * static_cast<double>(samples.points.size());
}

}  // namespace

std::optional<Vector3d> eye_of_view(const RecognitionModel& scene) {
  const SurfaceSamples& samples = scene.samples;
  if (std::ranges::find(samples.rim, 1) == samples.rim.end()) return std::nullopt;
  const Vector3d origin = -scene.origin;
  if (is_faced(samples, origin)) return origin;
  Vector3d mean = Vector3d::Zero();
  for (const Eigen::Vector3f& normal : samples.normals) mean += normal.cast<double>();
  if (!(mean.norm() > 0)) return std::nullopt;
  const Vector3d far_away =
      scene.centre.cast<double>() + kFarAway * scene.diagonal * mean.normalized();
  if (is_faced(samples, far_away)) return far_away;
  return std::nullopt;
}

}  // namespace semigeo::kernels
