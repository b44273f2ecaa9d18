#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "bench/support/chance.hpp"
#include "kernels/repair/range_grid.hpp"
#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::recognition {

// A scanner that measures the distance along rays through the pixels of a perspective camera. In
// its own frame the camera stands at the origin and looks against z; x points to the right and y
// upwards.

/// Describes a camera in its own frame.
struct Camera {
  double focal = 1;   ///< Focal length, in pixels.
  double left = 0;    ///< Place of the left edge of column 0, in pixels from the axis.
  double bottom = 0;  ///< Place of the lower edge of row 0, in pixels from the axis.
  std::int64_t columns = 0;
  std::int64_t rows = 0;

  /// Returns the point of depth 1 on the ray of a pixel.
  Eigen::Vector3d ray(std::int64_t row, std::int64_t column) const;
};

/// Returns the camera that has all points just within its image, of `pixels` pixels on the longer
/// side. All points must lie before the camera.
Camera camera_for(std::span<const Eigen::Vector3d> points, std::int64_t pixels);

/// Holds what the pixels of a camera measure, row after row, the lowest row first.
struct DepthImage {
  std::vector<double> depth;  ///< Distance from the plane of the camera; 0 if nothing is met.
  std::vector<std::int32_t> object;  ///< Index of the object that the ray meets, or -1.
};

/// Returns what a camera sees of objects: the depths of the surfaces that the rays meet first.
DepthImage render(std::span<const kernels::TriangleMesh> objects, const Camera& camera);

/// Says how a scanner errs. Lengths are in widths of a pixel at the depth of the surface.
struct ScannerErrors {
  double noise = 0;    ///< Sigma of the noise along the ray.
  double quantum = 0;  ///< Depths are multiples of this length at the mean depth; 0: exact.
  /// Share of the pixels beside a depth jump that see both surfaces. They measure a depth between.
  double mixed = 0;
};

/// Adds errors to an image. A mixed pixel belongs to no object. A pixel lies beside a depth jump if
/// a neighbour is more than four widths of a pixel farther away.
void disturb(DepthImage& image, const Camera& camera, const ScannerErrors& errors,
             bench::Random& random);

/// Holds a triangulated image.
struct VirtualScan {
  kernels::TriangleMesh mesh;        ///< In the camera's frame. Every point belongs to a pixel.
  std::vector<std::int32_t> object;  ///< Object of each point, or -1.
};

/// Triangulates an image as the program triangulates range grids.
VirtualScan triangulated(const DepthImage& image, const Camera& camera);

/// Returns the area of the triangles with three corners on the same object, for each object.
std::vector<double> areas_of_objects(const VirtualScan& scan, std::size_t objects);

}  // namespace semigeo::recognition
