#pragma once

#include <array>
#include <cstdint>

#include "kernels/recognition/similarity.hpp"
#include "kernels/recognition/triplet.hpp"

namespace semigeo::kernels {

/// Returns three features as points with normals, corner by corner.
inline OrientedTriangle feature_triangle(const OrientedFeatures& features,
                                         const std::array<std::uint16_t, 3>& corners) {
  OrientedTriangle triangle;
  for (int i = 0; i < 3; ++i) {
    const OrientedFeature& feature = features.features[corners[i]];
    triangle.points[i] = feature.position.cast<double>();
    triangle.normals[i] = feature.normal.cast<double>();
  }
  return triangle;
}

}  // namespace semigeo::kernels
