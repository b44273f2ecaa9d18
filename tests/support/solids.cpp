#include "tests/support/solids.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/support/shapes.hpp"

namespace semigeo::shapes {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;
using kernels::TriangleMesh;

SignedDistance united(std::vector<SignedDistance> parts, double blend) {
  return [parts = std::move(parts), blend](const Vector3d& p) {
    double least = parts[0](p);
    for (std::size_t i = 1; i < parts.size(); ++i) {
      const double d = parts[i](p);
      const double overlap = std::max(0.0, 1 - std::abs(least - d) / blend);
      least = std::min(least, d) - blend / 4 * overlap * overlap;
    }
    return least;
  };
}

SignedDistance ball(const Vector3d& centre, double radius) {
  return [=](const Vector3d& p) { return (p - centre).norm() - radius; };
}

SignedDistance capsule(const Vector3d& from, const Vector3d& to, double radius) {
  return [=](const Vector3d& p) {
    const Vector3d along = to - from;
    const double t = std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (p - from - t * along).norm() - radius;
  };
}

SignedDistance rounded_box(const Vector3d& centre, const Vector3d& half, double rounding) {
  return [=](const Vector3d& p) {
    const Vector3d q = (p - centre).cwiseAbs() - half + Vector3d::Constant(rounding);
    return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0) - rounding;
  };
}

TriangleMesh dumbbell(double bar) {
  const Vector3d end(2, 0, 0);
  return isosurface(united({ball(-end, 1), ball(end, 1), capsule(-end, end, bar)}, 0.1),
                    {Vector3d(-3.2, -1.2, -1.2), Vector3d(3.2, 1.2, 1.2)}, 0.36);
}

TriangleMesh phone() {
  const auto end = [](double x) { return rounded_box({x, 0, 0}, {0.4, 0.5, 0.35}, 0.15); };
  const SignedDistance grip = rounded_box({0, 0, 0}, {1.5, 0.3, 0.125}, 0.12);
  return isosurface(united({end(-1.5), end(1.5), grip}, 0.1),
                    {Vector3d(-2.1, -0.7, -0.6), Vector3d(2.1, 0.7, 0.6)}, 0.21);
}

TriangleMesh chair() {
  std::vector<SignedDistance> parts = {rounded_box({0, 0, 0}, {0.6, 0.6, 0.15}, 0.15),
                                       rounded_box({0, -0.6, 1}, {0.6, 0.15, 0.4}, 0.15)};
  for (const double x : {-0.45, 0.45}) {
    for (const double y : {-0.45, 0.45}) parts.push_back(capsule({x, y, 0}, {x, y, -1}, 0.11));
    parts.push_back(capsule({x, -0.5, 0}, {x, -0.6, 1}, 0.09));
  }
  return isosurface(united(std::move(parts), 0.05),
                    {Vector3d(-0.8, -0.9, -1.3), Vector3d(0.8, 0.8, 1.6)}, 0.18);
}

TriangleMesh bumpy_sphere(int levels, double height) {
  TriangleMesh mesh = icosphere(levels);
  for (auto& p : mesh.points)
    p *= 1 + height * std::sin(5 * p.x()) * std::cos(4 * p.y()) * std::cos(6 * p.z());
  return mesh;
}

}  // namespace semigeo::shapes
