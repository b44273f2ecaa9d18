#include "kernels/curvature.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>

namespace semigeo::kernels {
namespace {

/// Smallest pivot, relative to the whole patch's, that a truncated patch's quadratic may have.
constexpr double kMinPivot = 2e-3;

using Basis = Eigen::Matrix<double, 6, 1>;

/// 1, u, v, u^2/2, u v, v^2/2: the coefficients are the derivatives themselves.
Basis basis(double u, double v) {
  Basis b;
  b << 1, u, v, u * u / 2, u * v, v * v / 2;
  return b;
}

PatchDerivatives per_length(PatchDerivatives d, float step) {
  const float s1 = 1 / step;
  const float s2 = s1 * s1;
  d.ru *= s1;
  d.rv *= s1;
  d.ruu *= s2;
  d.ruv *= s2;
  d.rvv *= s2;
  return d;
}

Eigen::Vector3f paired_mean(const Patch& patch) {
  const auto& g = gaussian_filters().smooth;
  Eigen::Vector4f sum = Eigen::Vector4f::Zero();
  for (int c = 0; c < kTaps; ++c)
    for (int r = 0; r < kTaps; ++r)
      if (patch.has(c, r) && patch.has(kTaps - 1 - c, kTaps - 1 - r))
        sum += g[c] * g[r] * patch.sample[c][r];
  return sum.head<3>();
}

}  // namespace

PatchDerivatives convolve(const Patch& patch, float step) {
  const GaussianFilters& g = gaussian_filters();
  Eigen::Vector4f r, ru, rv, ruu, ruv, rvv;
  r = ru = rv = ruu = ruv = rvv = Eigen::Vector4f::Zero();
  for (int c = 0; c < kTaps; ++c) {
    // Separable: first along the column (v), then across the columns (u).  (4.4), (4.11)
    Eigen::Vector4f s0, s1, s2;
    s0 = s1 = s2 = Eigen::Vector4f::Zero();
    for (int k = 0; k < kTaps; ++k) {
      const Eigen::Vector4f& p = patch.sample[c][k];
      s0 += g.smooth[k] * p;
      s1 += g.first[k] * p;
      s2 += g.second[k] * p;
    }
    r += g.smooth[c] * s0;
    ru += g.first[c] * s0;
    ruu += g.second[c] * s0;
    rv += g.smooth[c] * s1;
    ruv += g.first[c] * s1;
    rvv += g.smooth[c] * s2;
  }
  return per_length(
      {r.head<3>(), ru.head<3>(), rv.head<3>(), ruu.head<3>(), ruv.head<3>(), rvv.head<3>()}, step);
}

TruncatedDerivatives fit_truncated(const Patch& patch, float step) {
  const auto& g = gaussian_filters().smooth;
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 3> right = Eigen::Matrix<double, 6, 3>::Zero();
  for (int c = 0; c < kTaps; ++c)
    for (int k = 0; k < kTaps; ++k) {
      if (!patch.has(c, k)) continue;
      const Basis b = basis(c - kReach, k - kReach);
      const double weight = static_cast<double>(g[c]) * g[k];
      normal.noalias() += weight * b * b.transpose();
      right.noalias() += weight * b * patch.sample[c][k].head<3>().cast<double>().transpose();
    }
  TruncatedDerivatives result{};
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> ldlt(normal);
  result.ok = ldlt.info() == Eigen::Success && ldlt.vectorD().minCoeff() > kMinPivot;
  PatchDerivatives& d = result.derivatives;
  if (result.ok) {
    const Eigen::Matrix<float, 6, 3> x = ldlt.solve(right).cast<float>();
    d = per_length({x.row(0), x.row(1), x.row(2), x.row(3), x.row(4), x.row(5)}, step);
  }
  d.r = paired_mean(patch);
  return result;
}

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

}  // namespace semigeo::kernels
