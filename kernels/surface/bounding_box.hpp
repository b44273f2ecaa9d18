#pragma once

#include <Eigen/Geometry>

namespace semigeo::kernels {

/// Returns the smallest axis-parallel box that holds all points, in their precision. It is empty if
/// there are no points. `Points` is any range of vectors of three coordinates. The cost is linear.
template <typename Points>
auto bounding_box(const Points& points) {
  using Scalar = typename Points::value_type::Scalar;
  Eigen::AlignedBox<Scalar, 3> box;
  for (const auto& p : points) box.extend(p);
  return box;
}

}  // namespace semigeo::kernels
