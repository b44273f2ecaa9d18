#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/recognition/recognition_model.hpp"
#include "kernels/surface/connectivity.hpp"

namespace semigeo::kernels {

/// Returns `count` points spread evenly over the area of a surface, in such an order that the first
/// n of them, for any n, are spread evenly, too. `normals` (N) are those of the vertices, and are
/// interpolated. A surface without area has no points. `rim` is left empty. The cost is O(F log F +
/// count).
SurfaceSamples sample_surface(std::span<const Eigen::Vector3f> points,
                              std::span<const Triangle> triangles,
                              std::span<const Eigen::Vector3f> normals, std::int64_t count);

/// Fills `rim` of samples of this surface: those within two spacings of an edge that only one
/// triangle has are marked. Beyond them nobody knows how the surface continues.
void mark_rim(std::span<const Eigen::Vector3f> points, std::span<const Triangle> triangles,
              SurfaceSamples& samples);

}  // namespace semigeo::kernels
