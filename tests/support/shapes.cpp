#include "tests/support/shapes.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>

namespace semigeo::shapes {
namespace {

using Eigen::Vector3d;
using Triangle = std::array<std::int32_t, 3>;

/// Triangles of an nu x nv grid of vertices, cells split along alternating diagonals; `wrap_*`
/// joins the last row to the first.
void grid_triangles(TriangleMesh& mesh, int nu, int nv, bool wrap_u, bool wrap_v) {
  const auto at = [&](int i, int j) { return static_cast<std::int32_t>((i % nu) * nv + j % nv); };
  for (int i = 0; i < (wrap_u ? nu : nu - 1); ++i)
    for (int j = 0; j < (wrap_v ? nv : nv - 1); ++j) {
      const auto a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      if ((i + j) % 2 == 0) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
      } else {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({b, c, d});
      }
    }
}

}  // namespace

TriangleMesh icosphere(int levels, double radius) {
  TriangleMesh mesh;
  const double g = std::numbers::phi;
  for (const double s : {-1.0, 1.0})
    for (const double t : {-g, g}) {
      mesh.points.push_back(Vector3d(s, t, 0).normalized());
      mesh.points.push_back(Vector3d(0, s, t).normalized());
      mesh.points.push_back(Vector3d(t, 0, s).normalized());
    }
  // Faces of the icosahedron: triples of mutually nearest vertices.
  const auto near = [&](int i, int j) { return mesh.points[i].dot(mesh.points[j]) > 0.4; };
  for (std::int32_t a = 0; a < 12; ++a)
    for (std::int32_t b = a + 1; b < 12; ++b)
      for (std::int32_t c = b + 1; c < 12; ++c) {
        if (!near(a, b) || !near(b, c) || !near(c, a)) continue;
        const bool outward = mesh.points[a].dot(mesh.points[b].cross(mesh.points[c])) > 0;
        mesh.triangles.push_back(outward ? Triangle{a, b, c} : Triangle{a, c, b});
      }
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middle;
    const auto split = [&](std::int32_t a, std::int32_t b) {
      const auto [it, fresh] =
          middle.try_emplace(std::minmax(a, b), static_cast<std::int32_t>(mesh.points.size()));
      if (fresh) mesh.points.push_back((mesh.points[a] + mesh.points[b]).normalized());
      return it->second;
    };
    std::vector<Triangle> finer;
    finer.reserve(4 * mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles) {
      const auto ab = split(a, b), bc = split(b, c), ca = split(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  for (auto& p : mesh.points) p *= radius;
  return mesh;
}

TriangleMesh torus(double major, double minor, int nu, int nv, double unevenness) {
  TriangleMesh mesh;
  for (int i = 0; i < nu; ++i)
    for (int j = 0; j < nv; ++j) {
      const double s = 2 * std::numbers::pi * i / nu;
      const double t = 2 * std::numbers::pi * j / nv;
      const double u = s + unevenness * (std::sin(3 * s) / 3 + 0.2 * std::sin(t));
      const double v = t + unevenness * (std::sin(2 * t) / 2 + 0.2 * std::sin(2 * s));
      const double ring = major + minor * std::cos(v);
      mesh.points.emplace_back(ring * std::cos(u), ring * std::sin(u), minor * std::sin(v));
    }
  grid_triangles(mesh, nu, nv, true, true);
  return mesh;
}

TriangleMesh rough_torus(double size) {
  TriangleMesh mesh = torus(size, 0.4 * size, 80, 36, 0.3);
  add_noise(mesh, 0.01 * size, 1);
  return mesh;
}

TriangleMesh cylinder(double radius, double height, int around, int along) {
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j <= along; ++j) {
      const double u = 2 * std::numbers::pi * i / around;
      mesh.points.emplace_back(radius * std::cos(u), radius * std::sin(u),
                               height * (static_cast<double>(j) / along - 0.5));
    }
  grid_triangles(mesh, around, along + 1, true, false);
  return mesh;
}

TriangleMesh saddle(double size, int n, double bend) {
  TriangleMesh mesh;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const double x = size * (static_cast<double>(i) / n - 0.5);
      const double y = size * (static_cast<double>(j) / n - 0.5);
      mesh.points.emplace_back(x, y, bend * (x * x - y * y) / 2);
    }
  grid_triangles(mesh, n + 1, n + 1, false, false);
  return mesh;
}

TriangleMesh plane(double size, int n) {
  return saddle(size, n, 0);
}

TriangleMesh cube(double size, int n) {
  TriangleMesh mesh;
  std::map<std::array<int, 3>, std::int32_t> index;  // lattice point to vertex
  const auto vertex = [&](const std::array<int, 3>& q) {
    const auto [it, fresh] = index.try_emplace(q, static_cast<std::int32_t>(mesh.points.size()));
    if (fresh)
      mesh.points.push_back(size * (Vector3d(q[0], q[1], q[2]) / n - Vector3d::Constant(0.5)));
    return it->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int di, int dj) {
            std::array<int, 3> q{};
            q[axis] = side;
            q[(axis + 1) % 3] = i + di;
            q[(axis + 2) % 3] = j + dj;
            return vertex(q);
          };
          const auto a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          if (side == n) {
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
          } else {
            mesh.triangles.push_back({a, c, b});
            mesh.triangles.push_back({a, d, c});
          }
        }
  return mesh;
}

TriangleMesh hemisphere(int levels, double radius) {
  TriangleMesh mesh = icosphere(levels, radius);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return (mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]).z() < 0;
  });
  return mesh;  // vertices of the lower half stay, unused
}

void add_noise(TriangleMesh& mesh, double sigma, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  // Not std::uniform_real_distribution: its result differs between standard libraries.
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53 * 2 - 1; };
  for (auto& p : mesh.points)
    for (int c = 0; c < 3; ++c) p[c] += std::sqrt(3.0) * sigma * uniform();
}

}  // namespace semigeo::shapes
