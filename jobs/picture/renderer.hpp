#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "io/files/image.hpp"
#include "jobs/picture/camera.hpp"
#include "jobs/picture/colour_scale.hpp"

namespace semigeo::jobs {

/// A view of a surface that is drawn, in somebody else's memory.
struct DrawnSurface {
  std::span<const float> points;            ///< (N, 3)
  std::span<const float> normals;           ///< (N, 3); or empty: they are made of the triangles.
  std::span<const std::int64_t> triangles;  ///< (F, 3), rows of `points`
  std::span<const float> values;  ///< (N) field, NaN where it is not valid; or empty: no field.
  float limit = 1;                ///< The value at the end of the colour scale.
};

/// A line that is drawn on the surface.
struct DrawnLine {
  std::vector<Eigen::Vector3f> points;  ///< In the surface's unit of length.
  Colour colour = {};
};

/// A point that is marked by a disc.
struct DrawnMark {
  Eigen::Vector3f point = Eigen::Vector3f::Zero();
  Colour colour = {};
};

/// How a surface is drawn.
struct RenderOptions {
  int width = 256;
  int height = 256;
  ColourScale scale = ColourScale::kSafe;
  Colour background = {1, 1, 1};
  bool transparent = false;  ///< Pixels beside the surface are transparent.
  float line_width = 2;      ///< In pixels.
  float mark_radius = 3;     ///< In pixels.
};

/// Draws a shaded surface, its lines and marks; what lies behind the surface is hidden. Pixels are
/// the mean of nine samples. Both sides of the surface are drawn, inner sides darker. Points must
/// be finite to be seen. Throws std::invalid_argument if the arrays do not fit each other, or a
/// corner is no row. A picture of 1200 x 1200 pixels of 100,000 vertices takes a quarter of a
/// second, and besides the result 20 bytes a vertex and a few MB. Thread-safe.
io::Image render(const DrawnSurface& surface, const Camera& camera, const RenderOptions& options,
                 std::span<const DrawnLine> lines = {}, std::span<const DrawnMark> marks = {});

}  // namespace semigeo::jobs
