#include "tests/support/analytic_surfaces.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace semigeo::shapes {
namespace {

using Eigen::Vector3d;

constexpr double kTurn = 2 * std::numbers::pi;

SurfacePoint sphere_at(const Vector3d& direction) {
  const Vector3d n = direction.normalized();
  return {n, n, 1, -1};
}

SurfacePoint ellipsoid_at(const Vector3d& direction) {
  const Vector3d axes(1, 0.7, 0.5);
  const Vector3d p = axes.cwiseProduct(direction.normalized());
  const Vector3d gradient = p.cwiseQuotient(axes.cwiseAbs2());
  const double w = gradient.squaredNorm();
  const double product = axes.prod() * axes.prod();
  return {p, gradient.normalized(), 1 / (product * w * w),
          (p.squaredNorm() - axes.squaredNorm()) / (2 * product * w * std::sqrt(w))};
}

SurfacePoint torus_at(const Vector3d& st) {
  constexpr double kMajor = 1, kMinor = 0.4;
  const double u = kTurn * st.x(), v = kTurn * st.y();
  const Vector3d n(std::cos(v) * std::cos(u), std::cos(v) * std::sin(u), std::sin(v));
  const double ring = kMajor + kMinor * std::cos(v);
  const Vector3d p(ring * std::cos(u), ring * std::sin(u), kMinor * std::sin(v));
  return {p, n, std::cos(v) / (kMinor * ring), -(1 / kMinor + std::cos(v) / ring) / 2};
}

/// Of radius 1, and about as long as wide.
SurfacePoint cylinder_at(const Vector3d& st) {
  const double u = kTurn * st.x();
  const Vector3d n(std::cos(u), std::sin(u), 0);
  return {{n.x(), n.y(), 2.5 * (st.y() - 0.5)}, n, 0, -0.5};
}

SurfacePoint saddle_at(const Vector3d& st) {
  const double x = 2 * st.x() - 1, y = 2 * st.y() - 1;
  const double w = 1 + x * x + y * y;
  return {{x, y, (x * x - y * y) / 2},
          Vector3d(-x, y, 1) / std::sqrt(w),
          -1 / (w * w),
          (y * y - x * x) / (2 * w * std::sqrt(w))};
}

SurfacePoint enneper_at(const Vector3d& st) {
  const double u = 1.6 * (st.x() - 0.5), v = 1.6 * (st.y() - 0.5);
  const double w = 1 + u * u + v * v;
  return {{u - u * u * u / 3 + u * v * v, v - v * v * v / 3 + v * u * u, u * u - v * v},
          Vector3d(-2 * u, 2 * v, 2 - w) / w,
          -4 / (w * w * w * w),
          0};
}

}  // namespace

std::span<const AnalyticSurface> analytic_surfaces() {
  static const std::array<AnalyticSurface, 6> surfaces = {{
      {"sphere", Domain::kSphere, sphere_at},
      {"ellipsoid", Domain::kSphere, ellipsoid_at},
      {"torus", Domain::kTorus, torus_at},
      {"cylinder", Domain::kCylinder, cylinder_at},
      {"saddle", Domain::kSquare, saddle_at},
      {"enneper", Domain::kSquare, enneper_at},
  }};
  return surfaces;
}

}  // namespace semigeo::shapes
