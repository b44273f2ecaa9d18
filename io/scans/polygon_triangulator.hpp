#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace semigeo::io {

/// Cuts polygons in space into triangles between their corners, oriented as the polygon is. Works
/// in the plane of the polygon's Newell normal. Simple polygons, convex or not, come out without
/// overlaps, also with holes joined by bridges. For polygons that cross themselves or have no area
/// only the number of triangles is promised. The class is not thread-safe, because an instance
/// keeps its working memory for the next polygon.
class PolygonTriangulator {
 public:
  /// Returns n - 2 triangles of indices into `corners` (n >= 3), valid until the next call. Takes
  /// at most about 4096 n steps: a larger polygon that needs more becomes a fan in the end.
  std::span<const std::array<std::int32_t, 3>> triangulate(
      std::span<const Eigen::Vector3d> corners);

 private:
  void cut_quad(std::span<const Eigen::Vector3d> corners);
  void clip_ears(std::span<const Eigen::Vector3d> corners, const Eigen::Vector3d& normal);
  bool is_ear(std::int32_t corner);
  /// Returns whether a corner and its neighbours coincide so that cutting it off takes no area.
  bool is_spike(std::int32_t corner) const;
  double area(std::int32_t a, std::int32_t b, std::int32_t c) const;
  void find_reflex();

  std::vector<std::array<std::int32_t, 3>> triangles_;
  std::vector<Eigen::Vector2d> flat_;
  std::vector<std::int32_t> next_, previous_;
  std::vector<std::int32_t> reflex_;  // may hold corners that are clipped or convex by now
  std::vector<char> is_reflex_;
  std::int64_t steps_left_ = 0;
};

}  // namespace semigeo::io
