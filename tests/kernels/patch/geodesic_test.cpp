#include "kernels/patch/geodesic.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "tests/support/prepared_surface.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::kernels {
namespace {

using Eigen::Vector3f;

/// The face point at p + s direction for the first face it lies in, on a planar region of the mesh.
Ray ray_at(const PreparedSurface& s, const Vector3f& p, const Vector3f& direction) {
  for (std::int32_t f = 0; f < s.surface.face_count(); ++f) {
    const auto& t = s.surface.triangles[f];
    const Vector3f a = s.points[t[0]].head<3>();
    const Vector3f e1 = s.points[t[1]].head<3>() - a, e2 = s.points[t[2]].head<3>() - a;
    const Vector3f n = e1.cross(e2);
    if (std::abs(n.normalized().dot(p - a)) > 1e-5f) continue;
    const float x = (p - a).cross(e2).dot(n) / n.squaredNorm();
    const float y = e1.cross(p - a).dot(n) / n.squaredNorm();
    if (x < -1e-6f || y < -1e-6f || x + y > 1 + 1e-6f) continue;
    const Vector3f d = direction.normalized();
    return {{halfedge(f, 0), x, y},
            d.cross(e2).dot(n) / n.squaredNorm(),
            e1.cross(d).dot(n) / n.squaredNorm()};
  }
  return {};
}

TriangleMesh jittered_plane() {
  TriangleMesh mesh = shapes::plane(10, 20);
  shapes::add_noise(mesh, 0.1, 7);
  for (auto& p : mesh.points) p.z() = 0;
  return mesh;
}

// Theorem 6: across edges of a plane a geodesic is a straight line, in every direction.
TEST(GeodesicTest, PlaneIsStraight_Theorem6) {
  const PreparedSurface s(jittered_plane(), false);
  const GeodesicMesh mesh = s.mesh();
  const Vector3f start(0.13f, -0.21f, 0);
  for (int k = 0; k < 64; ++k) {
    const float angle = static_cast<float>(k) * 0.0982f;
    const Vector3f d(std::cos(angle), std::sin(angle), 0);
    GeodesicLine line(mesh, ray_at(s, start, d));
    for (int i = 1; i <= 8; ++i) {
      ASSERT_TRUE(line.advance(0.5f));
      EXPECT_LT((s.position(line.ray().at) - (start + 0.5f * i * d)).norm(), 2e-4f);
      EXPECT_LT((direction_in_space(mesh, line.ray()) - d).norm(), 2e-3f);
    }
  }
}

// A regular grid: the line runs along edges and through vertices all the way (Theorem 7, 5.2.3).
TEST(GeodesicTest, AlongEdgesThroughVertices_Theorem7) {
  const PreparedSurface s(shapes::plane(8, 8), false);
  const GeodesicMesh mesh = s.mesh();
  const std::int32_t centre = s.nearest({0, 0, 0});
  for (const Vector3f& d : {Vector3f(1, 0, 0), Vector3f(0, 1, 0), Vector3f(-1, 0, 0),
                            Vector3f(1, 1, 0), Vector3f(1, -1, 0), Vector3f(2, 1, 0)}) {
    GeodesicLine line(mesh, ray_from_vertex(mesh, centre, d));
    for (int i = 1; i <= 3; ++i) {
      ASSERT_TRUE(line.advance(1)) << d.transpose();
      EXPECT_LT((s.position(line.ray().at) - i * d.normalized()).norm(), 1e-4f);
    }
  }
}

// Figure 5.6: starting a hair's breadth off an edge's direction changes nothing to speak of.
TEST(GeodesicTest, NearlyParallelToAnEdge_Figure5_6) {
  const PreparedSurface s(shapes::plane(8, 8), false);
  const GeodesicMesh mesh = s.mesh();
  const std::int32_t centre = s.nearest({0, 0, 0});
  for (const float tilt : {1e-7f, 1e-6f, 1e-5f, 1e-4f, 1e-3f, -1e-6f, -1e-4f}) {
    GeodesicLine line(mesh, ray_from_vertex(mesh, centre, Vector3f(1, tilt, 0)));
    for (int i = 1; i <= 3; ++i) {
      ASSERT_TRUE(line.advance(1)) << tilt;
      EXPECT_LT((s.position(line.ray().at) - Vector3f(i, tilt * i, 0)).norm(), 5e-4f);
    }
  }
}

// A prism unfolded by hand: on each strip the height grows in proportion to the way round.
TEST(GeodesicTest, CylinderIsAHelix_Theorem6) {
  constexpr int kAround = 24;
  const PreparedSurface s(shapes::cylinder(1, 6, kAround, 24), false);
  const GeodesicMesh mesh = s.mesh();
  const float side = 2 * std::sin(std::numbers::pi_v<float> / kAround);
  // From the middle of a strip at angle pi / 24, which is a flat quad.
  const float half = std::numbers::pi_v<float> / kAround;
  const Vector3f start(std::cos(half) * std::cos(half), std::cos(half) * std::sin(half), 0.05f);
  const Vector3f round(-std::sin(half), std::cos(half), 0);
  for (const float slope : {0.0f, 0.3f, 1.0f, -0.5f}) {
    const Vector3f d = (round + slope * Vector3f(0, 0, 1)).normalized();
    GeodesicLine line(mesh, ray_at(s, start, d));
    const float way = 3.1f;  // along the geodesic
    ASSERT_TRUE(line.advance(way));
    const Vector3f end = s.position(line.ray().at);
    const float unfolded = way * d.dot(round);  // way round the prism
    EXPECT_NEAR(end.z(), 0.05f + way * d.z(), 2e-4f);
    const float strips = unfolded / side + 0.5f;
    const float strip = std::floor(strips);
    const float fraction = strips - strip;
    const auto corner = [&](float k) {
      return Eigen::Vector2f(std::cos(2 * half * k), std::sin(2 * half * k));
    };
    const Eigen::Vector2f expected = (1 - fraction) * corner(strip) + fraction * corner(strip + 1);
    EXPECT_LT((end.head<2>() - expected).norm(), 3e-4f);
  }
}

// Over the edge of a cube: the next face unfolded by hand into the plane of the first.
TEST(GeodesicTest, CubeUnfolds_Theorem6) {
  const PreparedSurface s(shapes::cube(2, 4), false);
  const GeodesicMesh mesh = s.mesh();
  const Vector3f start(0.3f, 0.1f, 1);  // on top
  const Vector3f d = Vector3f(1, 0.4f, 0).normalized();
  GeodesicLine line(mesh, ray_at(s, start, d));
  ASSERT_TRUE(line.advance(1.5f));
  // Reaches x = 1 after 0.7 / d.x, then goes down the face x = 1.
  const float left = 1.5f - 0.7f / d.x();
  const Vector3f expected(1, 0.1f + 1.5f * d.y(), 1 - left * d.x());
  EXPECT_LT((s.position(line.ray().at) - expected).norm(), 1e-4f);
}

// Theorem 7: at the corner of a cube the plane of the incoming line and the corner's normal.
TEST(GeodesicTest, CubeCornerFollowsTheNormalPlane_Theorem7) {
  const PreparedSurface s(shapes::cube(2, 1), false);
  const GeodesicMesh mesh = s.mesh();
  const std::int32_t corner = s.nearest({1, 1, 1});
  const Vector3f incoming(1, 1, 0);  // along the diagonal of the top
  const Ray ray = ray_from_vertex(mesh, corner, incoming);
  ASSERT_NE(ray.at.halfedge, kNone);
  // By symmetry it leaves down the vertical edge.
  GeodesicLine line(mesh, ray);
  ASSERT_TRUE(line.advance(0.5f));
  EXPECT_LT((s.position(line.ray().at) - Vector3f(1, 1, 0.5f)).norm(), 1e-4f);
}

// On a sphere a geodesic stays near a great circle, nearer on finer meshes.
TEST(GeodesicTest, SphereIsAGreatCircle) {
  double previous = 1;
  for (const int levels : {3, 4, 5}) {
    const PreparedSurface s(shapes::icosphere(levels), false);
    const GeodesicMesh mesh = s.mesh();
    double worst = 0;
    for (std::int32_t v = 0; v < s.surface.vertex_count(); v += 37) {
      const Vector3f n = s.points[v].head<3>().normalized();
      const Vector3f d = n.unitOrthogonal();
      GeodesicLine line(mesh, ray_from_vertex(mesh, v, d));
      ASSERT_TRUE(line.advance(1));
      const Vector3f end = s.position(line.ray().at).normalized();
      worst = std::max<double>(worst, std::abs(end.dot(n.cross(d))));
    }
    EXPECT_LT(worst, previous);
    previous = worst;
  }
  EXPECT_LT(previous, 1e-2);
}

TEST(GeodesicTest, EndsAtABoundary) {
  const PreparedSurface s(jittered_plane(), false);
  const GeodesicMesh mesh = s.mesh();
  GeodesicLine line(mesh, ray_at(s, {0.1f, 0.2f, 0}, {1, 0.3f, 0}));
  EXPECT_TRUE(line.advance(4));
  EXPECT_FALSE(line.advance(4));
  EXPECT_FALSE(line.advance(1e-3f));  // for good
}

TEST(GeodesicTest, OffABoundaryVertexThereIsNoWay) {
  const PreparedSurface s(shapes::plane(4, 4), false);
  const GeodesicMesh mesh = s.mesh();
  const std::int32_t edge = s.nearest({2, 0, 0});
  EXPECT_EQ(ray_from_vertex(mesh, edge, {1, 0, 0}).at.halfedge, kNone);
  EXPECT_NE(ray_from_vertex(mesh, edge, {-1, 0, 0}).at.halfedge, kNone);
  // Along the boundary itself, both ways.
  for (const float y : {-1.0f, 1.0f}) {
    GeodesicLine line(mesh, ray_from_vertex(mesh, edge, {0, y, 0}));
    ASSERT_TRUE(line.advance(1.5f));
    EXPECT_LT((s.position(line.ray().at) - Vector3f(2, 1.5f * y, 0)).norm(), 1e-4f);
  }
}

// A needle-thin fan: the number of faces crossed is bounded, whatever the geometry.
TEST(GeodesicTest, EndsAfterABoundedNumberOfFaces) {
  TriangleMesh needles;
  constexpr std::int32_t kFaces = 4 * kMaxCrossings;
  for (std::int32_t i = 0; i <= kFaces; ++i)
    for (const double y : {0.0, 1.0}) needles.points.emplace_back(i * 1e-3, y, 0);
  for (std::int32_t i = 0; i < kFaces; ++i) {
    const std::int32_t a = 2 * i;
    needles.triangles.push_back({a, a + 2, a + 1});
    needles.triangles.push_back({a + 1, a + 2, a + 3});
  }
  const PreparedSurface s(std::move(needles), false);
  const GeodesicMesh mesh = s.mesh();
  GeodesicLine line(mesh, ray_at(s, {0.0003f, 0.5f, 0}, {1, 0, 0}));
  EXPECT_TRUE(line.advance(0.15f));
  EXPECT_FALSE(line.advance(3.0f));
}

// The hub of a fan as CAD programs close a cylinder with: cost stays bounded.
TEST(GeodesicTest, EndsAtAHugeFan) {
  for (const std::int32_t valence : {kMaxFan, kMaxFan + 1}) {
    TriangleMesh fan;
    fan.points.emplace_back(0, 0, 0);
    for (std::int32_t i = 0; i < valence; ++i) {
      const double angle = 2 * std::numbers::pi * i / valence;
      fan.points.emplace_back(std::cos(angle), std::sin(angle), 0);
      fan.triangles.push_back({0, 1 + i, 1 + (i + 1) % valence});
    }
    const PreparedSurface s(std::move(fan), false);
    const Ray ray = ray_from_vertex(s.mesh(), s.nearest({0, 0, 0}), {1, 0.5f, 0});
    EXPECT_EQ(ray.at.halfedge != kNone, valence <= kMaxFan);
  }
}

// Figures 5.8 and 5.9: inside a face and on its edges the perpendicular lies in the face's plane.
TEST(PerpendicularTest, InAFace_Figures5_8_5_9) {
  const PreparedSurface s(jittered_plane(), false);
  const GeodesicMesh mesh = s.mesh();
  for (int k = 0; k < 16; ++k) {
    const float angle = static_cast<float>(k) * 0.41f;
    const Vector3f d(std::cos(angle), std::sin(angle), 0);
    const Perpendiculars p = perpendiculars(mesh, ray_at(s, {0.3f, 0.1f, 0}, d));
    const Vector3f left(-d.y(), d.x(), 0);
    EXPECT_LT((direction_in_space(mesh, p.left) - left).norm(), 1e-3f);
    EXPECT_LT((direction_in_space(mesh, p.right) + left).norm(), 1e-3f);
  }
}

// Figure 5.8: the sample lies on an edge that the line crosses at a right angle, an acute or an
// obtuse one. The edge is the ridge between two faces of a cube, so that one of the perpendiculars
// has to be unfolded at once; in (a) both run along the ridge.
TEST(PerpendicularTest, OnACrossedEdge_Figure5_8) {
  const PreparedSurface s(shapes::cube(2, 4), false);
  const GeodesicMesh mesh = s.mesh();
  // The face y = 1 turned about the ridge into the plane of the face z = 1.
  const auto unfolded = [&](const FacePoint& at) {
    const Vector3f p = s.position(at);
    return Eigen::Vector2f(p.x(), p.y() + (1 - p.z()));
  };
  for (const float degrees : {90.0f, 60.0f, 30.0f, 120.0f, 150.0f}) {
    const float phi = degrees * std::numbers::pi_v<float> / 180;
    const Eigen::Vector2f d(std::cos(phi), std::sin(phi));
    const Eigen::Vector2f on_ridge(0.1f, 1);
    const Eigen::Vector2f start = on_ridge - 0.4f * d;
    GeodesicLine line(mesh, ray_at(s, {start.x(), start.y(), 1}, {d.x(), d.y(), 0}));
    ASSERT_TRUE(line.advance(0.4f));
    ASSERT_LT((unfolded(line.ray().at) - on_ridge).norm(), 1e-5f);
    const Perpendiculars p = perpendiculars(mesh, line.ray());
    const Eigen::Vector2f left(-d.y(), d.x());
    for (const auto& [ray, side] :
         {std::pair<Ray, Eigen::Vector2f>(p.left, left), {p.right, -left}}) {
      GeodesicLine perpendicular(mesh, ray);
      for (int i = 1; i <= 3; ++i) {
        ASSERT_TRUE(perpendicular.advance(0.2f)) << degrees;
        const Eigen::Vector2f expected = on_ridge + 0.2f * static_cast<float>(i) * side;
        EXPECT_LT((unfolded(perpendicular.ray().at) - expected).norm(), 1e-3f) << degrees;
      }
    }
  }
}

// Figure 5.9 (a): the line lies on an edge; left and right leave it through different faces.
TEST(PerpendicularTest, OnAnEdge_Figure5_9a) {
  const PreparedSurface s(shapes::plane(8, 8), false);
  const GeodesicMesh mesh = s.mesh();
  const std::int32_t centre = s.nearest({0, 0, 0});
  GeodesicLine line(mesh, ray_from_vertex(mesh, centre, {1, 0, 0}));
  ASSERT_TRUE(line.advance(0.4f));
  const Perpendiculars p = perpendiculars(mesh, line.ray());
  for (const auto& [ray, y] : {std::pair(p.left, 1.0f), std::pair(p.right, -1.0f)}) {
    GeodesicLine side(mesh, ray);
    ASSERT_TRUE(side.advance(1.7f));
    EXPECT_LT((s.position(side.ray().at) - Vector3f(0.4f, 1.7f * y, 0)).norm(), 1e-4f);
  }
}

// Figure 5.7: a sample on a vertex uses the turned normal plane there.
TEST(PerpendicularTest, AtAVertex_Figure5_7) {
  const PreparedSurface s(shapes::plane(8, 8), false);
  const GeodesicMesh mesh = s.mesh();
  const std::int32_t centre = s.nearest({0, 0, 0});
  GeodesicLine line(mesh, ray_from_vertex(mesh, centre, {1, 0, 0}));
  ASSERT_TRUE(line.advance(1));  // the next vertex
  const Perpendiculars p = perpendiculars(mesh, line.ray());
  for (const auto& [ray, y] : {std::pair(p.left, 1.0f), std::pair(p.right, -1.0f)}) {
    GeodesicLine side(mesh, ray);
    ASSERT_TRUE(side.advance(1.5f));
    EXPECT_LT((s.position(side.ray().at) - Vector3f(1, 1.5f * y, 0)).norm(), 1e-4f);
  }
}

TEST(NormalTest, WeightsByAngleNotByFaces_Equation5_1) {
  // The corner of a cube sees three faces at 90 degrees each, one of them split in two.
  const PreparedSurface s(shapes::cube(2, 1), false);
  const Vector3f n = s.normals[s.nearest({1, 1, 1})];
  EXPECT_LT((n - Vector3f(1, 1, 1).normalized()).norm(), 1e-6f);
}

// Degenerate faces stay finite.
TEST(GeodesicTest, FlatTrianglesGiveFiniteCoefficients) {
  TriangleMesh triangles{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, -1, 0}},
                         {{0, 1, 2}, {0, 2, 3}, {1, 0, 4}, {2, 1, 4}}};
  const PreparedSurface s(std::move(triangles), false);
  for (const auto& face : s.faces)
    for (const auto& edge : face.edge) {
      EXPECT_TRUE(std::isfinite(edge.alpha) && std::isfinite(edge.beta));
      EXPECT_LE(edge.beta, 0);
    }
}

}  // namespace
}  // namespace semigeo::kernels
