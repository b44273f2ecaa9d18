#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string_view>

namespace semigeo::jobs {

/// The places from which a surface is looked at.
enum class View { kIso, kFront, kBack, kLeft, kRight, kTop, kBottom };
/// The names of the views, by View.
inline constexpr std::array<std::string_view, 7> kViewNames = {"iso",   "front", "back",  "left",
                                                               "right", "top",   "bottom"};

/// The axis of the scan that points upwards.
enum class UpAxis { kY, kZ };
/// The names of the axes, by UpAxis.
inline constexpr std::array<std::string_view, 2> kUpAxisNames = {"y", "z"};

/// An orthographic camera. All lengths in a picture are true, whatever their distance.
struct Camera {
  /// Rows: the directions to the right, upwards, and towards the viewer.
  Eigen::Matrix3f axes = Eigen::Matrix3f::Identity();
  Eigen::Vector3f centre = Eigen::Vector3f::Zero();  ///< The point in the middle of the picture.
  float pixels_per_length = 1;

  /// Returns the place of a point: pixels to the right and downwards from the middle of the
  /// picture, and pixels towards the viewer.
  Eigen::Vector3f place(const Eigen::Vector3f& point) const {
    const Eigen::Vector3f turned = pixels_per_length * (axes * (point - centre));
    return {turned.x(), -turned.y(), turned.z()};
  }
};

/// Returns the directions of a camera as `Camera::axes` has them. From the front, the viewer sees
/// the x axis to the right; the iso view looks from the front, the right and above.
Eigen::Matrix3f axes_of(View view, UpAxis up);

/// Returns the width of the smallest upright rectangle around all points of all surfaces, as this
/// camera's directions show it, in multiples of its height; 1 if they are not spread out.
float aspect_of(const Eigen::Matrix3f& axes, std::span<const std::span<const float>> surfaces);

/// Returns the camera that shows all points of all surfaces, each (N, 3), in a picture of this many
/// pixels, with a margin around them. Points that are not finite are passed over.
Camera fitted_camera(const Eigen::Matrix3f& axes, std::span<const std::span<const float>> surfaces,
                     int width, int height);

}  // namespace semigeo::jobs
