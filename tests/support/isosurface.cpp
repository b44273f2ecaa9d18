#include "tests/support/isosurface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace semigeo::shapes {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;
using kernels::TriangleMesh;

constexpr int kRelaxations = 10;

/// Points of the lattice are those with three even or three odd coordinates.
class Marcher {
 public:
  Marcher(const SignedDistance& distance, const Vector3d& corner, double cell)
      : distance_(distance), corner_(corner), cell_(cell) {}

  /// Adds the surface within a tetrahedron of lattice points.
  void march(const std::array<Vector3i, 4>& points) {
    std::vector<int> inside, outside;
    for (const Vector3i& p : points) (value(p) < 0 ? inside : outside).push_back(number(p));
    if (inside.size() == 2 && outside.size() == 2) {
      const int a = inside[0], b = inside[1], c = outside[0], d = outside[1];
      add(a, d, {cut(a, c), cut(b, c), cut(b, d)});
      add(a, d, {cut(a, c), cut(b, d), cut(a, d)});
    } else if (inside.size() == 1) {
      const int a = inside[0];
      add(a, outside[0], {cut(a, outside[0]), cut(a, outside[1]), cut(a, outside[2])});
    } else if (outside.size() == 1) {
      const int d = outside[0];
      add(inside[0], d, {cut(inside[0], d), cut(inside[1], d), cut(inside[2], d)});
    }
  }

  TriangleMesh take() { return std::move(mesh_); }

 private:
  int number(const Vector3i& p) {
    const auto [it, fresh] =
        numbers_.try_emplace({p.x(), p.y(), p.z()}, static_cast<int>(places_.size()));
    if (fresh) {
      places_.push_back(corner_ + cell_ / 2 * p.cast<double>());
      values_.push_back(distance_(places_.back()));
    }
    return it->second;
  }
  double value(const Vector3i& p) { return values_[number(p)]; }

  std::int32_t cut(int in, int out) {
    const auto [it, fresh] =
        cuts_.try_emplace({in, out}, static_cast<std::int32_t>(mesh_.points.size()));
    if (fresh) {
      // Not in a lattice point, where triangles would have no area to tell their sides by.
      const double t = std::clamp(values_[in] / (values_[in] - values_[out]), 0.02, 0.98);
      mesh_.points.push_back(places_[in] + t * (places_[out] - places_[in]));
    }
    return it->second;
  }

  /// Turns the triangle's front to `out`: it lies between any corner inside and any outside.
  void add(int in, int out, std::array<std::int32_t, 3> t) {
    const Vector3d a = mesh_.points[t[0]], b = mesh_.points[t[1]], c = mesh_.points[t[2]];
    if ((b - a).cross(c - a).dot(places_[out] - places_[in]) < 0) std::swap(t[1], t[2]);
    mesh_.triangles.push_back(t);
  }

  const SignedDistance& distance_;
  Vector3d corner_;
  double cell_;
  std::map<std::array<int, 3>, int> numbers_;
  std::vector<Vector3d> places_;
  std::vector<double> values_;
  std::map<std::pair<int, int>, std::int32_t> cuts_;
  TriangleMesh mesh_;
};

Vector3d projected(const SignedDistance& distance, Vector3d p, double length) {
  const double d = 1e-4 * length;
  for (int pass = 0; pass < 3; ++pass) {
    Vector3d gradient;
    for (int c = 0; c < 3; ++c) {
      const Vector3d along = d * Vector3d::Unit(c);
      gradient[c] = (distance(p + along) - distance(p - along)) / (2 * d);
    }
    p -= distance(p) * gradient / std::max(gradient.squaredNorm(), 0.25);
  }
  return p;
}

/// Moves every vertex to the middle of its neighbours and back to the surface.
void relax(TriangleMesh& mesh, const SignedDistance& distance, double length) {
  std::vector<Vector3d> sums(mesh.points.size(), Vector3d::Zero());
  std::vector<double> counts(mesh.points.size(), 0);
  for (const auto& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) {
      sums[t[i]] += mesh.points[t[(i + 1) % 3]];
      counts[t[i]] += 1;
    }
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    mesh.points[v] = projected(distance, sums[v] / counts[v], length);
}

}  // namespace

TriangleMesh isosurface(const SignedDistance& distance, const Eigen::AlignedBox3d& box,
                        double cell) {
  Marcher marcher(distance, box.min(), cell);
  const Vector3i cells = (box.sizes() / cell).array().ceil().cast<int>();
  for (int i = 0; i < cells.x(); ++i)
    for (int j = 0; j < cells.y(); ++j)
      for (int k = 0; k < cells.z(); ++k)
        for (int axis = 0; axis < 3; ++axis) {
          const Vector3i centre = 2 * Vector3i(i, j, k) + Vector3i::Ones();
          const Vector3i along = Vector3i::Unit(axis);
          const Vector3i u = Vector3i::Unit((axis + 1) % 3), v = Vector3i::Unit((axis + 2) % 3);
          // Round the square that this cell and the next one share.
          const std::array<Vector3i, 4> square = {u + v, v - u, -u - v, u - v};
          for (int side = 0; side < 4; ++side)
            marcher.march({centre, centre + 2 * along, centre + along + square[side],
                           centre + along + square[(side + 1) % 4]});
        }
  TriangleMesh mesh = marcher.take();
  for (int pass = 0; pass < kRelaxations; ++pass) relax(mesh, distance, cell);
  return mesh;
}

}  // namespace semigeo::shapes
