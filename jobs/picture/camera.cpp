#include "jobs/picture/camera.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace semigeo::jobs {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;

/// The part of a picture that the surfaces take, along the side that is full.
constexpr float kFilled = 0.94f;

/// Returns where the viewer stands, when y points upwards and the front is towards z.
Vector3f towards_viewer(View view) {
  switch (view) {
    case View::kIso:
      return Vector3f(1.0f, 0.8f, 1.6f).normalized();
    case View::kFront:
      return {0, 0, 1};
    case View::kBack:
      return {0, 0, -1};
    case View::kLeft:
      return {-1, 0, 0};
    case View::kRight:
      return {1, 0, 0};
    case View::kTop:
      return {0, 1, 0};
    case View::kBottom:
      return {0, -1, 0};
  }
  return {0, 0, 1};
}

/// Corners of a box in the directions of a camera. Without points, `low` is above `high`.
struct Box {
  Vector3f low = Vector3f::Constant(std::numeric_limits<float>::max());
  Vector3f high = -low;
};

Box box_of(const Matrix3f& axes, std::span<const std::span<const float>> surfaces) {
  Box box;
  for (const std::span<const float> points : surfaces)
    for (std::size_t i = 0; i + 2 < points.size(); i += 3) {
      const Vector3f point = axes * Vector3f(points[i], points[i + 1], points[i + 2]);
      if (!point.allFinite()) continue;
      box.low = box.low.cwiseMin(point);
      box.high = box.high.cwiseMax(point);
    }
  return box;
}

}  // namespace

Matrix3f axes_of(View view, UpAxis up) {
  const Vector3f viewer = towards_viewer(view);
  // Seen from the top, the front of the surface lies at the lower edge of the picture.
  const Vector3f above = view == View::kTop      ? Vector3f(0, 0, -1)
                         : view == View::kBottom ? Vector3f(0, 0, 1)
                                                 : Vector3f(0, 1, 0);
  Matrix3f axes;
  axes.row(0) = above.cross(viewer).normalized();
  axes.row(1) = viewer.cross(Vector3f(axes.row(0)));
  axes.row(2) = viewer;
  if (up == UpAxis::kY) return axes;
  Matrix3f standing;  // z becomes y, and the front is towards -y
  standing << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  return axes * standing;
}

float aspect_of(const Matrix3f& axes, std::span<const std::span<const float>> surfaces) {
  const Box box = box_of(axes, surfaces);
  const Vector3f size = box.high - box.low;
  const float aspect = size.x() / size.y();
  return size.x() > 0 && size.y() > 0 && std::isfinite(aspect) ? aspect : 1.0f;
}

Camera fitted_camera(const Matrix3f& axes, std::span<const std::span<const float>> surfaces,
                     int width, int height) {
  const Box box = box_of(axes, surfaces);
  Camera camera;
  camera.axes = axes;
  if (box.low.x() > box.high.x()) return camera;  // there is no point
  camera.centre = axes.transpose() * (0.5f * (box.low + box.high));
  const Vector3f size = box.high - box.low;
  if (!(size.norm() > 0)) return camera;  // one point, as large as the length unit
  const float smallest = 1e-6f * size.norm();
  camera.pixels_per_length =
      kFilled * std::min(static_cast<float>(width) / std::max(size.x(), smallest),
                         static_cast<float>(height) / std::max(size.y(), smallest));
  return camera;
}

}  // namespace semigeo::jobs
