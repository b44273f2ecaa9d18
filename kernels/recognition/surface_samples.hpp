#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/recognition/recognition_model.hpp"

namespace semigeo::kernels {

/// `count` points spread evenly over the area of a surface, in such an order that the first n of
/// them, for any n, are spread evenly too. `normals` are those of the vertices, (N, 3), which are
/// interpolated. Where there is no area there are no points. No `rim`. Cost: O(F log F + count).
SurfaceSamples sample_surface(std::span<const Eigen::Vector3f> points,
                              std::span<const std::array<std::int32_t, 3>> triangles,
                              std::span<const Eigen::Vector3f> normals, std::int64_t count);

/// Fills `rim` of samples of this surface: marks those within two spacings of an edge that only one
/// triangle has. Beyond them nobody knows how the surface goes on.
void mark_rim(std::span<const Eigen::Vector3f> points,
              std::span<const std::array<std::int32_t, 3>> triangles, SurfaceSamples& samples);

}  // namespace semigeo::kernels
