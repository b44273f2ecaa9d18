#include "kernels/evolution/curvature.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace semigeo::kernels {

Curvature curvature_from_forms(const PatchDerivatives& d) {
  const float e = d.ru.squaredNorm();
  const float f = d.ru.dot(d.rv);
  const float g = d.rv.squaredNorm();
  const Eigen::Vector3f cross = d.ru.cross(d.rv);
  const float area2 = cross.squaredNorm();  // E G - F^2
  if (!(area2 > 0)) return {0, 0, Eigen::Vector3f::Zero()};
  const Eigen::Vector3f n = cross / std::sqrt(area2);
  const float l = d.ruu.dot(n);
  const float m = d.ruv.dot(n);
  const float nn = d.rvv.dot(n);
  return {(l * nn - m * m) / area2,                    // A.2.2, K
          (l * g + e * nn - 2 * f * m) / (2 * area2),  // A.2.2, H
          n};
}

Curvature curvature_semigeodesic(const PatchDerivatives& d) {
  const Eigen::Vector3f cross = d.ru.cross(d.rv);  // (A, B, C) of (4.9)
  const float norm = cross.norm();
  const float g = d.rv.squaredNorm();  // x_v^2 + y_v^2 + z_v^2
  if (!(norm > 0)) return {0, 0, Eigen::Vector3f::Zero()};
  const Eigen::Vector3f n = cross / norm;
  const float buu = d.ruu.dot(n);
  const float buv = d.ruv.dot(n);
  const float bvv = d.rvv.dot(n);
  return {(buu * bvv - buv * buv) / g,  // (4.9)
          (bvv + g * buu) / (2 * g),    // (4.10)
          n};
}

PrincipalCurvatures principal_curvatures(const PatchDerivatives& d) {
  const float e = d.ru.squaredNorm();
  const Eigen::Vector3f cross = d.ru.cross(d.rv);
  const float area = cross.norm();
  if (!(area > 0)) return {};
  const Eigen::Vector3f n = cross / area;
  const Eigen::Vector3f e1 = d.ru / std::sqrt(e);
  const Eigen::Vector3f e2 = n.cross(e1);
  // e1 = P_u / sqrt(E); e2 = (P_v - F/E P_u) sqrt(E) / area.
  const float shear = d.ru.dot(d.rv) / e;
  const float l = d.ruu.dot(n);
  const float m = d.ruv.dot(n);
  const float nn = d.rvv.dot(n);
  const float h11 = l / e;
  const float h12 = (m - shear * l) / area;
  const float h22 = (nn - 2 * shear * m + shear * shear * l) * e / (area * area);
  const float mean = (h11 + h22) / 2;
  const float half = (h11 - h22) / 2;
  const float radius = std::sqrt(half * half + h12 * h12);
  const float angle = std::atan2(h12, half) / 2;
  const Eigen::Vector3f first = std::cos(angle) * e1 + std::sin(angle) * e2;
  return {mean + radius, mean - radius, first, n.cross(first)};
}

}  // namespace semigeo::kernels
