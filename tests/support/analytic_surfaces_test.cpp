#include "tests/support/analytic_surfaces.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "kernels/repair/surface_builder.hpp"

namespace semigeo::shapes {
namespace {

using Eigen::Vector3d;

/// Two parameter directions at p, right-handed seen from outside.
std::pair<Vector3d, Vector3d> directions(Domain domain, const Vector3d& p) {
  if (domain != Domain::kSphere) return {Vector3d::UnitX(), Vector3d::UnitY()};
  const Vector3d first = p.unitOrthogonal();
  return {first, p.normalized().cross(first)};
}

// The closed forms against difference quotients of the positions.
TEST(AnalyticSurfacesTest, CurvatureIsThatOfThePositions) {
  for (const AnalyticSurface& surface : analytic_surfaces())
    for (const Vector3d& p : {Vector3d(0.31, 0.42, 0), Vector3d(0.9, 0.13, 0.2)}) {
      const Vector3d at =
          surface.domain == Domain::kSphere ? p.normalized().eval() : Vector3d(p.x(), p.y(), 0);
      const auto [du, dv] = directions(surface.domain, at);
      const double h = 1e-3;
      const auto r = [&](int i, int j) { return surface.at(at + h * (i * du + j * dv)).position; };
      const Vector3d ru = (r(1, 0) - r(-1, 0)) / (2 * h), rv = (r(0, 1) - r(0, -1)) / (2 * h);
      const Vector3d ruu = (r(1, 0) - 2 * r(0, 0) + r(-1, 0)) / (h * h);
      const Vector3d rvv = (r(0, 1) - 2 * r(0, 0) + r(0, -1)) / (h * h);
      const Vector3d ruv = (r(1, 1) - r(1, -1) - r(-1, 1) + r(-1, -1)) / (4 * h * h);
      const Vector3d n = ru.cross(rv).normalized();
      const double e = ru.dot(ru), f = ru.dot(rv), g = rv.dot(rv);
      const double l = ruu.dot(n), m = ruv.dot(n), k = rvv.dot(n);
      const SurfacePoint truth = surface.at(at);
      EXPECT_NEAR((truth.normal - n).norm(), 0, 1e-4) << surface.name;
      EXPECT_NEAR(truth.gaussian, (l * k - m * m) / (e * g - f * f), 1e-3) << surface.name;
      EXPECT_NEAR(truth.mean, (e * k - 2 * f * m + g * l) / (2 * (e * g - f * f)), 1e-3)
          << surface.name;
    }
}

struct EdgeLengths {
  double shortest = 1e30;
  double longest = 0;
};

EdgeLengths edge_lengths(const AnalyticMesh& m) {
  EdgeLengths result;
  for (const auto& t : m.mesh.triangles)
    for (int i = 0; i < 3; ++i) {
      const double length = (m.mesh.points[t[i]] - m.mesh.points[t[(i + 1) % 3]]).norm();
      result.shortest = std::min(result.shortest, length);
      result.longest = std::max(result.longest, length);
    }
  return result;
}

TEST(AnalyticSurfacesTest, TessellationsAreManifoldAndFaceOutwards) {
  for (const AnalyticSurface& surface : analytic_surfaces())
    for (const auto kind : {Tessellation::kEven, Tessellation::kUneven, Tessellation::kRagged,
                            Tessellation::kNeedles}) {
      SCOPED_TRACE(surface.name + " " + name_of(kind));
      AnalyticMesh m = tessellate(surface, kind, 2500);
      ASSERT_EQ(m.truth.size(), m.mesh.points.size());
      EXPECT_NEAR(m.mesh.points.size(), 2600, 250);
      for (const auto& t : m.mesh.triangles) {
        const auto& p = m.mesh.points;
        const Vector3d normal = (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).normalized();
        ASSERT_GT(normal.dot(m.truth[t[0]].normal), kind == Tessellation::kNeedles ? 0 : 0.5);
      }
      const auto count = static_cast<std::int64_t>(m.mesh.points.size());
      const kernels::BuiltSurface built = kernels::build_surface(std::move(m.mesh));
      EXPECT_EQ(built.repairs, kernels::SurfaceRepairs{});
      EXPECT_EQ(built.surface.vertex_count(), count);
      EXPECT_EQ(built.surface.part_count, 1);
      std::int64_t rim = 0;
      for (std::int32_t v = 0; v < count; ++v) rim += built.surface.on_boundary(v);
      EXPECT_EQ(rim > 0, surface.open());
    }
}

TEST(AnalyticSurfacesTest, NeedlesHaveShortEdgesAndHubs) {
  const AnalyticMesh m = tessellate(analytic_surfaces()[2], Tessellation::kNeedles, 10000);
  const EdgeLengths lengths = edge_lengths(m);
  EXPECT_GT(lengths.longest, 50 * lengths.shortest);
  std::map<std::int32_t, int> valence;
  for (const auto& t : m.mesh.triangles)
    for (const std::int32_t v : t) ++valence[v];
  const auto hubs = std::ranges::count_if(valence, [](const auto& v) { return v.second == 30; });
  EXPECT_GE(hubs, 20);
}

TEST(AnalyticSurfacesTest, UnevenEdgesDiffer) {
  const EdgeLengths even =
      edge_lengths(tessellate(analytic_surfaces()[0], Tessellation::kEven, 2500));
  const EdgeLengths uneven =
      edge_lengths(tessellate(analytic_surfaces()[0], Tessellation::kUneven, 2500));
  EXPECT_LT(even.longest, 1.5 * even.shortest);
  EXPECT_GT(uneven.longest, 3 * uneven.shortest);
}

TEST(AnalyticSurfacesTest, NoiseHasItsSigmaAlongTheNormal) {
  AnalyticMesh m = tessellate(analytic_surfaces()[0], Tessellation::kEven, 10000);
  const double edge = mean_edge_length(m.mesh);
  add_normal_noise(m, 0.05 * edge, 7);
  double variance = 0;
  for (const auto& p : m.mesh.points) variance += std::pow(p.norm() - 1, 2);
  EXPECT_NEAR(std::sqrt(variance / m.mesh.points.size()) / edge, 0.05, 0.002);
}

}  // namespace
}  // namespace semigeo::shapes
