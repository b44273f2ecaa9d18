#include "kernels/patch/patch.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "kernels/surface/circulators.hpp"
#include "tests/support/prepared_surface.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::kernels {
namespace {

using Eigen::Vector3f;

// On a plane the patch is the square grid along its first edge (4.1.2: Cartesian coordinates).
TEST(PatchTest, PlaneGivesTheCartesianGrid_Figure5_10) {
  TriangleMesh mesh = shapes::plane(20, 20);
  shapes::add_noise(mesh, 0.15, 3);
  for (auto& p : mesh.points) p.z() = 0;
  const PreparedSurface s(std::move(mesh));
  const GeodesicMesh m = s.mesh();
  const std::int32_t v = s.nearest({0, 0, 0});
  for (const std::int32_t first : outgoing(s.surface, v)) {
    Patch patch;
    trace_patch(s.sampled(), v, first, 0.8f, patch);
    ASSERT_TRUE(patch.whole());
    EXPECT_NEAR(patch.completeness(), 1, 1e-6);
    const Vector3f u = (m.point(v) - m.point(m.origin(next(first)))).normalized();
    const Vector3f w = Vector3f(0, 0, 1).cross(u);
    for (int i = -kReach; i <= kReach; ++i)
      for (int j = -kReach; j <= kReach; ++j) {
        const Vector3f expected = 0.8f * (i * u + j * w);
        EXPECT_LT((patch.sample[i + kReach][j + kReach].head<3>() - expected).norm(), 1e-3f);
      }
  }
}

// Every sample of the curved surface lies on the sphere to fourth order; flat samples lie inside.
TEST(PatchTest, CurvedSamplesLieOnTheSphere) {
  const PreparedSurface curved(shapes::icosphere(4));
  const PreparedSurface flat(shapes::icosphere(4), false);
  const auto h = static_cast<float>(mean_edge_length(curved.surface));
  Patch patch;
  for (std::int32_t v = 0; v < curved.surface.vertex_count(); v += 11) {
    const Vector3f centre = curved.points[v].head<3>();
    const auto worst = [&](const PreparedSurface& s) {
      trace_patch(s.sampled(), v, first_edge(s.mesh(), v), h, patch);
      EXPECT_TRUE(patch.whole());
      float error = 0;
      for (const auto& column : patch.sample)
        for (const auto& p : column)
          error = std::max(error, std::abs((centre + p.head<3>()).norm() - 1));
      return error;
    };
    EXPECT_LT(worst(curved), 1e-4f);
    EXPECT_GT(worst(flat), 4e-4f);
  }
}

// Figure 5.4: the base line begins along an edge (u < 0) and goes on beyond its vertex in the plane
// of that edge and W (u > 0). On a ridge W halves the angle, and the plane leads down the other
// side.
TEST(PatchTest, TheBaseLineGoesOnInTheNormalPlane_Figure5_4) {
  const PreparedSurface s(shapes::cube(2, 4), false);
  const GeodesicMesh m = s.mesh();
  const std::int32_t v = s.nearest({0, 1, 1});
  std::int32_t first = m.outgoing[v];
  while ((m.point(m.origin(next(first))) - Vector3f(0, 0.5f, 1)).norm() > 1e-6f)
    first = m.twin(prev(first));
  Patch patch;
  trace_patch(s.sampled(), v, first, 0.25f, patch);
  ASSERT_TRUE(patch.whole());
  for (int i = 1; i <= kReach; ++i) {
    const float u = 0.25f * static_cast<float>(i);
    EXPECT_LT((patch.sample[kReach - i][kReach].head<3>() - Vector3f(0, -u, 0)).norm(), 1e-4f);
    EXPECT_LT((patch.sample[kReach + i][kReach].head<3>() - Vector3f(0, 0, -u)).norm(), 1e-4f);
  }
}

// The patch is right-handed: u x v points outwards.
TEST(PatchTest, IsRightHanded) {
  const PreparedSurface s(shapes::icosphere(3));
  Patch patch;
  for (std::int32_t v = 0; v < s.surface.vertex_count(); v += 5) {
    trace_patch(s.sampled(), v, first_edge(s.mesh(), v), 0.05f, patch);
    const Vector3f u = patch.sample[kReach + 1][kReach].head<3>();
    const Vector3f w = patch.sample[kReach][kReach + 1].head<3>();
    EXPECT_GT(u.cross(w).dot(s.points[v].head<3>()), 0);
  }
}

TEST(PatchTest, ABoundaryTruncatesIt) {
  const PreparedSurface s(shapes::plane(20, 20));
  Patch patch;
  const auto completeness = [&](const Vector3f& p) {
    const std::int32_t v = s.nearest(p);
    trace_patch(s.sampled(), v, first_edge(s.mesh(), v), 1, patch);
    return patch.completeness();
  };
  EXPECT_FLOAT_EQ(completeness({0, 0, 0}), 1);
  EXPECT_FLOAT_EQ(completeness({5, 0, 0}), 1);
  const float near = completeness({8, 0, 0}), rim = completeness({10, 0, 0}),
              corner = completeness({10, 10, 0});
  EXPECT_LT(near, 1);
  EXPECT_LT(rim, near);
  EXPECT_LT(corner, rim);
  EXPECT_GT(rim, 0.4f);  // half of the Gaussian and its middle line
  EXPECT_GT(corner, 0.2f);
}

TEST(PatchTest, AVertexOnTheRimLooksInwards) {
  const PreparedSurface s(shapes::plane(20, 20));
  const std::int32_t v = s.nearest({10, 0, 0});
  const std::int32_t first = first_edge(s.mesh(), v);
  const Vector3f d = s.mesh().point(s.mesh().origin(next(first))) - s.mesh().point(v);
  EXPECT_LT(d.normalized().x(), -0.6f);
}

}  // namespace
}  // namespace semigeo::kernels
