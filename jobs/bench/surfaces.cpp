#include "jobs/bench/surfaces.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace semigeo::jobs {
namespace {

using Eigen::Vector3d;
using kernels::TriangleMesh;
using Corners = std::array<std::int32_t, 3>;

/// Draws numbers that are the same with every standard library. Their distributions differ.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : bits_(seed) {}
  /// Returns a number from -1 to 1.
  double signed_unit() { return static_cast<double>(bits_() >> 11) * 0x1p-52 - 1; }
  Vector3d in_cube() {
    const double x = signed_unit(), y = signed_unit();
    return {x, y, signed_unit()};
  }
  Vector3d direction() {
    Vector3d p = in_cube();
    while (p.squaredNorm() > 1 || p.squaredNorm() < 0.01) p = in_cube();
    return p.normalized();
  }

 private:
  std::mt19937_64 bits_;
};

/// Returns the twelve corners of an icosahedron.
std::array<Vector3d, 12> icosahedron() {
  std::array<Vector3d, 12> corners;
  for (int i = 0; i < 12; ++i) {
    const int axis = i / 4;
    Vector3d p = Vector3d::Zero();
    p[axis] = i % 2 == 0 ? 1 : -1;
    p[(axis + 1) % 3] = i % 4 < 2 ? std::numbers::phi : -std::numbers::phi;
    corners[i] = p;
  }
  return corners;
}

/// Adds the faces of one corner triangle, cut into n^2. Points on its sides are found by their
/// coordinates: they are sums of the same products in the same order for both neighbours.
void add_face(TriangleMesh& mesh, std::map<std::array<double, 3>, std::int32_t>& known,
              const std::array<Vector3d, 3>& corners, int n) {
  const bool outwards = corners[0].dot(corners[1].cross(corners[2])) > 0;
  const auto vertex = [&](int i, int j) {
    const Vector3d p = (n - i - j) * corners[0] + i * corners[1] + j * corners[2];
    const auto [at, fresh] =
        known.try_emplace({p.x(), p.y(), p.z()}, static_cast<std::int32_t>(mesh.points.size()));
    if (fresh) mesh.points.push_back(p.normalized());
    return at->second;
  };
  const auto add = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
    mesh.triangles.push_back(outwards ? Corners{a, b, c} : Corners{a, c, b});
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) {
      add(vertex(i, j), vertex(i + 1, j), vertex(i, j + 1));
      if (i + j + 1 < n) add(vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1));
    }
}

/// Splits every edge whose two ends are chosen. Faces with one split edge are cut in two, so that
/// no vertex lies on an edge.
void refine(TriangleMesh& mesh, const std::vector<bool>& chosen) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
  const auto middle = [&](std::int32_t a, std::int32_t b) -> std::int32_t {
    if (!chosen[a] || !chosen[b]) return -1;
    const auto [at, fresh] =
        middles.try_emplace(std::minmax(a, b), static_cast<std::int32_t>(mesh.points.size()));
    if (fresh) mesh.points.push_back((mesh.points[a] + mesh.points[b]) / 2);
    return at->second;
  };
  std::vector<Corners> finer;
  for (const Corners& t : mesh.triangles) {
    const auto count = std::count_if(t.begin(), t.end(), [&](auto v) { return chosen[v]; });
    // An edge needs two chosen corners, so there are three split edges, one, or none.
    if (count < 2) {
      finer.push_back(t);
    } else if (count == 3) {
      const auto ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
      finer.insert(finer.end(), {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
    } else {
      const auto apex = std::find_if(t.begin(), t.end(), [&](auto v) { return !chosen[v]; });
      const auto i = apex - t.begin();
      const auto p = t[i], q = t[(i + 1) % 3], r = t[(i + 2) % 3];
      finer.insert(finer.end(), {{p, q, middle(q, r)}, {p, middle(q, r), r}});
    }
  }
  mesh.triangles = std::move(finer);
}

/// Drops the vertices that no face has, and numbers the others anew in their order.
void drop_unused(TriangleMesh& mesh) {
  std::vector<std::int32_t> number(mesh.points.size(), -1);
  for (const Corners& t : mesh.triangles)
    for (const auto v : t) number[v] = 0;
  std::int32_t count = 0;
  for (std::size_t v = 0; v < number.size(); ++v)
    if (number[v] == 0) {
      mesh.points[count] = mesh.points[v];
      number[v] = count++;
    }
  mesh.points.resize(count);
  for (Corners& t : mesh.triangles)
    for (auto& v : t) v = number[v];
}

}  // namespace

TriangleMesh even_sphere(std::int64_t vertices) {
  const double cells = std::max(1.0, static_cast<double>(vertices - 2) / 10);
  const int n = static_cast<int>(std::ceil(std::sqrt(cells)));
  const std::array<Vector3d, 12> corners = icosahedron();
  const auto near = [&](int i, int j) { return (corners[i] - corners[j]).squaredNorm() < 5; };
  TriangleMesh mesh;
  std::map<std::array<double, 3>, std::int32_t> known;
  for (int a = 0; a < 12; ++a)
    for (int b = a + 1; b < 12; ++b)
      for (int c = b + 1; c < 12; ++c)
        if (near(a, b) && near(b, c) && near(c, a))
          add_face(mesh, known, {corners[a], corners[b], corners[c]}, n);
  return mesh;
}

TriangleMesh boulder(std::int64_t vertices, std::uint64_t seed) {
  constexpr int kBumps = 24;
  constexpr double kNarrowness = 12;
  Chance chance(seed);
  std::array<Vector3d, kBumps> centres;
  for (Vector3d& centre : centres) centre = chance.direction();
  TriangleMesh mesh = even_sphere(vertices);
  for (Vector3d& p : mesh.points) {
    double radius = 1;
    for (int i = 0; i < kBumps; ++i)
      radius += (i % 2 == 0 ? 0.15 : -0.1) * std::exp(kNarrowness * (p.dot(centres[i]) - 1));
    p *= radius;
  }
  return mesh;
}

TriangleMesh scan_like(std::int64_t vertices) {
  // A third of the surface has four times the vertices, and the rim cuts off a tenth.
  TriangleMesh mesh = boulder(static_cast<std::int64_t>(0.56 * static_cast<double>(vertices)), 1);
  const auto count = static_cast<double>(mesh.points.size());
  const double edge = std::sqrt(8 * std::numbers::pi / std::sqrt(3.0) / count);
  Chance chance(2);
  for (Vector3d& p : mesh.points) p += 0.3 * edge * chance.in_cube().cross(p.normalized());
  std::vector<bool> fine;
  for (const Vector3d& p : mesh.points) fine.push_back(p.x() > 0.3);
  refine(mesh, fine);
  // Noise is that of the finer part's edges, so that it does not fold them.
  for (Vector3d& p : mesh.points) p *= 1 + 0.05 * edge * chance.signed_unit();
  const std::array<Vector3d, 3> holes = {Vector3d(1, 0.2, 0.3), Vector3d(-0.9, 0.4, 0.4),
                                         Vector3d(0, -1, 0.1)};
  std::erase_if(mesh.triangles, [&](const Corners& t) {
    const Vector3d centre = (mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]) / 3;
    const auto in_hole = [&](const Vector3d& hole) {
      return (centre.normalized() - hole.normalized()).norm() < 0.15;
    };
    return centre.z() < -0.8 || std::any_of(holes.begin(), holes.end(), in_hole);
  });
  drop_unused(mesh);
  return mesh;
}

}  // namespace semigeo::jobs
