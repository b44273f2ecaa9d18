#include "kernels/repair/remeshing.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "kernels/patch/geodesic.hpp"
#include "kernels/repair/surface_builder.hpp"
#include "kernels/surface/vertex_order.hpp"
#include "tests/kernels/repair/level_meshes.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/soundness.hpp"

namespace semigeo::kernels {
namespace {

using tests::euler_characteristic;
using tests::expect_sound;
using tests::fault_of;
using tests::level_mesh;

/// Least height of all faces; no side is shorter.
double shortest(const LevelMesh& mesh) {
  double height2 = 1e300;
  for (std::int32_t f = 0; f < mesh.connectivity.face_count(); ++f)
    height2 = std::min(height2, mesh.height2(f));
  return std::sqrt(height2);
}

RemeshCounts remove_odd_faces(LevelMesh& mesh, double length) {
  std::vector<std::int32_t> faces;
  find_odd_faces(mesh, 0, static_cast<std::int32_t>(mesh.connectivity.face_count()), length, faces);
  Remesher remesher(mesh, true);
  remesher.remove_odd(faces, length);
  return remesher.finish();
}

RemeshCounts refine_to(LevelMesh& mesh, std::int64_t faces, double longest, double least,
                       bool curved = true) {
  std::vector<std::int32_t> edges;
  find_long_edges(mesh, 0, static_cast<std::int32_t>(mesh.connectivity.face_count()), longest,
                  edges);
  Remesher remesher(mesh, curved);
  remesher.refine(edges, faces, longest, least);
  return remesher.finish();
}

/// A surface of revolution about z: `around` vertices on each circle, a vertex at either end.
TriangleMesh lathe(const std::vector<std::pair<double, double>>& radius_and_height, int around) {
  TriangleMesh mesh;
  const auto rings = static_cast<int>(radius_and_height.size()) - 2;
  mesh.points.push_back({0, 0, radius_and_height.front().second});
  for (int k = 1; k <= rings; ++k)
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * M_PI * i / around;
      const auto [r, z] = radius_and_height[k];
      mesh.points.push_back({r * std::cos(angle), r * std::sin(angle), z});
    }
  mesh.points.push_back({0, 0, radius_and_height.back().second});
  const auto at = [&](int k, int i) { return 1 + (k - 1) * around + i % around; };
  const auto last = static_cast<std::int32_t>(mesh.points.size()) - 1;
  for (int i = 0; i < around; ++i) {
    mesh.triangles.push_back({0, at(1, i + 1), at(1, i)});
    for (int k = 1; k < rings; ++k) {
      mesh.triangles.push_back({at(k, i), at(k, i + 1), at(k + 1, i)});
      mesh.triangles.push_back({at(k, i + 1), at(k + 1, i + 1), at(k + 1, i)});
    }
    mesh.triangles.push_back({at(rings, i), at(rings, i + 1), last});
  }
  return mesh;
}

/// Two balls of radius 1 on a bar of this radius.
TriangleMesh dumbbell(double bar) {
  std::vector<std::pair<double, double>> profile;
  for (int k = 0; k <= 16; ++k) {
    const double angle = M_PI * k / 16;
    profile.emplace_back(std::sin(angle), -2 - std::cos(angle));
  }
  profile.back().first = bar;
  for (int k = 1; k < 8; ++k) profile.emplace_back(bar, -1 + k * 0.25);
  for (int k = 0; k <= 16; ++k) {
    const double angle = M_PI * k / 16;
    profile.emplace_back(k == 0 ? bar : std::sin(angle), 2 - std::cos(angle));
  }
  return lathe(profile, 24);
}

TEST(RemeshingTest, WithoutOddFacesNothingHappens) {
  LevelMesh mesh = level_mesh(shapes::icosphere(3));
  const auto triangles = mesh.connectivity.triangles;
  EXPECT_EQ(remove_odd_faces(mesh, 0.1), RemeshCounts{});
  EXPECT_EQ(mesh.connectivity.triangles, triangles);
}

TEST(RemeshingTest, NoOddFaceIsLeft) {
  for (const double length : {0.05, 0.2, 0.5, 1.5}) {
    TriangleMesh torus = shapes::torus(1, 0.4, 80, 40, 0.8);
    shapes::add_noise(torus, 0.01, 3);
    LevelMesh mesh = level_mesh(torus);
    const auto before = mesh.vertex_count();
    const RemeshCounts counts = remove_odd_faces(mesh, length);
    expect_sound(mesh);
    EXPECT_EQ(mesh.vertex_count(), before - counts.removed + counts.inserted);
    if (mesh.vertex_count() > 0) {
      EXPECT_GE(shortest(mesh), length);
    }
  }
}

TEST(RemeshingTest, CollapsingKeepsASphereASphere) {
  LevelMesh mesh = level_mesh(shapes::icosphere(5));
  const double edge = 0.06;
  remove_odd_faces(mesh, edge);
  expect_sound(mesh);
  EXPECT_EQ(euler_characteristic(mesh.connectivity), 2);
  for (const auto& p : mesh.points) EXPECT_NEAR(p.head<3>().norm(), 1, 4e-3);
  // No face is turned inwards.
  for (const auto& t : mesh.connectivity.triangles) {
    const Eigen::Vector3d a = mesh.point(t[0]);
    EXPECT_GT((mesh.point(t[1]) - a).cross(mesh.point(t[2]) - a).dot(a), 0);
  }
}

TEST(RemeshingTest, AThinNeckTearsAndBothEndsAreClosed) {
  LevelMesh mesh = level_mesh(dumbbell(0.02));
  const RemeshCounts counts = remove_odd_faces(mesh, 0.06);
  expect_sound(mesh);
  EXPECT_EQ(mesh.part_count, 2);
  EXPECT_GE(counts.torn, 1);
  EXPECT_EQ(euler_characteristic(mesh.connectivity), 4);
  // What is above comes from above.
  const LevelMesh before = level_mesh(dumbbell(0.02));
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const double old_height = before.points[mesh.source[v]].z();
    if (std::abs(mesh.points[v].z()) > 1) {
      EXPECT_GT(old_height * mesh.points[v].z(), 0);
    }
  }
}

TEST(RemeshingTest, AThickNeckHolds) {
  LevelMesh mesh = level_mesh(dumbbell(0.4));
  const RemeshCounts counts = remove_odd_faces(mesh, 0.06);
  expect_sound(mesh);
  EXPECT_EQ(mesh.part_count, 1);
  EXPECT_EQ(counts.torn, 0);
}

TEST(RemeshingTest, AThinHandleOpens) {
  LevelMesh mesh = level_mesh(shapes::torus(1, 0.02, 60, 12));
  const RemeshCounts counts = remove_odd_faces(mesh, 0.08);
  expect_sound(mesh);
  EXPECT_GE(counts.torn, 1);
  EXPECT_EQ(euler_characteristic(mesh.connectivity), 2 * mesh.part_count);
}

TEST(RemeshingTest, ASmallHoleClosesAndALargeOneStays) {
  TriangleMesh sphere = shapes::icosphere(4);
  sphere.triangles.erase(sphere.triangles.begin() + 100);
  LevelMesh mesh = level_mesh(sphere);
  EXPECT_EQ(euler_characteristic(mesh.connectivity), 1);
  remove_odd_faces(mesh, 0.02);
  EXPECT_EQ(euler_characteristic(mesh.connectivity), 1);
  remove_odd_faces(mesh, 0.12);
  expect_sound(mesh);
  EXPECT_EQ(euler_characteristic(mesh.connectivity), 2);
}

TEST(RemeshingTest, ABoundaryKeepsItsPlace) {
  TriangleMesh sheet = shapes::plane(2, 20);
  sheet.points[22] = sheet.points[1] + 0.01 * (sheet.points[22] - sheet.points[1]);
  sheet.points[7] = sheet.points[8] + 0.01 * (sheet.points[7] - sheet.points[8]);
  LevelMesh mesh = level_mesh(sheet);
  remove_odd_faces(mesh, 0.05);
  expect_sound(mesh);
  double reach = 0;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const Eigen::Vector4f& p = mesh.points[v];
    reach = std::max<double>(reach, p.head<2>().cwiseAbs().maxCoeff());
    if (mesh.connectivity.on_boundary(static_cast<std::int32_t>(v))) {
      EXPECT_NEAR(p.head<2>().cwiseAbs().maxCoeff(), 1, 1e-6);
    }
  }
  EXPECT_NEAR(reach, 1, 1e-6);
}

TEST(RemeshingTest, ARibbonOfShortRungsIsCutToPieces) {
  TriangleMesh ribbon;
  for (int k = 0; k <= 20; ++k)
    for (const double y : {0.0, k < 10 ? 0.01 : 0.3}) ribbon.points.push_back({0.1 * k, y, 0});
  for (int k = 0; k < 20; ++k) {
    ribbon.triangles.push_back({2 * k, 2 * k + 2, 2 * k + 1});
    ribbon.triangles.push_back({2 * k + 2, 2 * k + 3, 2 * k + 1});
  }
  LevelMesh mesh = level_mesh(ribbon);
  const RemeshCounts counts = remove_odd_faces(mesh, 0.05);
  expect_sound(mesh);
  EXPECT_GE(counts.torn, 8);
  EXPECT_GE(shortest(mesh), 0.05);
  EXPECT_EQ(mesh.part_count, 1);  // the wide end
  for (const auto& p : mesh.points) EXPECT_GT(p.x(), 0.85);
}

// Half way between a and b lies beyond a face that a has alone, and so does b.
TEST(RemeshingTest, AFaceIsNotTurnedOverIfThereIsAnotherWay) {
  LevelMesh mesh = level_mesh({{{0, 0, 0},
                                {0.1, 0, 0},
                                {0.001, 0.11, 0},
                                {0.005, 1, 0},
                                {0.12, 1, 0},
                                {-1, 0, 0},
                                {1, 0, 0},
                                {0.05, -1, 0}},
                               {{0, 1, 2},
                                {1, 0, 7},
                                {0, 2, 3},
                                {1, 4, 2},
                                {2, 4, 3},
                                {0, 3, 5},
                                {0, 5, 7},
                                {1, 7, 6},
                                {1, 6, 4}}});
  std::vector<std::int32_t> edges;
  for (std::int32_t f = 0; f < 9; ++f)
    for (int i = 0; i < 3; ++i)
      if (std::abs(mesh.length2(halfedge(f, i)) - 0.01) < 1e-6) edges = {halfedge(f, i)};
  ASSERT_EQ(edges.size(), 1);
  Remesher remesher(mesh, false);
  remesher.remove_odd({{face_of(edges.front())}}, 0.1001);
  remesher.finish();
  expect_sound(mesh);
  for (const auto& t : mesh.connectivity.triangles) {
    const Eigen::Vector3d a = mesh.point(t[0]);
    EXPECT_GT((mesh.point(t[1]) - a).cross(mesh.point(t[2]) - a).z(), 0);
  }
}

TEST(RemeshingTest, AFlatFaceIsFlippedAway) {
  // Every vertex of one column lies nearly on the line between its neighbours in another.
  TriangleMesh sheet = shapes::plane(2, 10);
  for (std::size_t f = 0; f < sheet.triangles.size(); f += 7) {
    const auto t = sheet.triangles[f];
    const Eigen::Vector3d middle =
        (sheet.points[t[0]] + sheet.points[t[1]] + sheet.points[t[2]]) / 3;
    const auto apex = static_cast<std::int32_t>(sheet.points.size());
    const Eigen::Vector3d edge = (sheet.points[t[0]] + sheet.points[t[1]]) / 2;
    sheet.points.push_back(edge + 0.02 * (middle - edge));
    sheet.triangles[f] = {t[0], t[1], apex};
    sheet.triangles.push_back({t[1], t[2], apex});
    sheet.triangles.push_back({t[2], t[0], apex});
  }
  LevelMesh mesh = level_mesh(sheet);
  const RemeshCounts counts = remove_odd_faces(mesh, 0.04);
  expect_sound(mesh);
  EXPECT_GE(shortest(mesh), 0.04);
  EXPECT_GT(counts.flipped, 20);
  EXPECT_EQ(counts.torn, 0);
  EXPECT_LT(counts.collapsed, 10);  // where the edge lies on the rim
  for (const auto& t : mesh.connectivity.triangles) {
    const Eigen::Vector3d a = mesh.point(t[0]);
    EXPECT_GT((mesh.point(t[1]) - a).cross(mesh.point(t[2]) - a).z(), 0);
  }
}

// All sides long, all corners on a line: what is left of a tube that has shrunk to its axis.
TEST(RemeshingTest, AWhiskerDissolves) {
  std::vector<std::pair<double, double>> profile;
  for (int k = 0; k <= 12; ++k) profile.emplace_back(1e-4, 0.3 * k);
  TriangleMesh whisker = lathe(profile, 3);
  for (std::size_t v = 1; v + 1 < whisker.points.size(); ++v)
    whisker.points[v].z() += 0.1 * static_cast<double>((v - 1) % 3);
  LevelMesh mesh = level_mesh(whisker);
  const RemeshCounts counts = remove_odd_faces(mesh, 0.05);
  expect_sound(mesh);
  EXPECT_EQ(mesh.vertex_count(), 4);
  EXPECT_EQ(counts.dropped_parts, counts.torn);
}

TEST(RemeshingTest, AVertexInsideATriangleOfShortEdgesGoesWithoutACut) {
  // A flat pyramid on one face of an icosahedron, one of whose base edges is short.
  TriangleMesh solid = shapes::icosphere(0);
  const auto t = solid.triangles[0];
  solid.points[t[1]] = solid.points[t[0]] + 0.01 * (solid.points[t[1]] - solid.points[t[0]]);
  const auto apex = static_cast<std::int32_t>(solid.points.size());
  solid.points.push_back(1.2 * (solid.points[t[0]] + solid.points[t[1]] + solid.points[t[2]]) / 3);
  solid.triangles[0] = {t[0], t[1], apex};
  solid.triangles.push_back({t[1], t[2], apex});
  solid.triangles.push_back({t[2], t[0], apex});
  LevelMesh mesh = level_mesh(solid);
  const RemeshCounts counts = remove_odd_faces(mesh, 0.1);
  expect_sound(mesh);
  EXPECT_EQ(counts.torn, 0);
  EXPECT_EQ(counts.dropped_parts, 0);
  EXPECT_EQ(euler_characteristic(mesh.connectivity), 2);
}

TEST(RemeshingTest, WhatCollapsesIsDroppedButForTheLast) {
  TriangleMesh two = shapes::icosphere(2, 0.01);
  const auto n = static_cast<std::int32_t>(two.points.size());
  for (const auto& p : shapes::icosphere(2, 0.01).points)
    two.points.push_back(p + Eigen::Vector3d(5, 0, 0));
  for (const auto& t : shapes::icosphere(2, 0.01).triangles)
    two.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  LevelMesh mesh = level_mesh(two);
  const RemeshCounts counts = remove_odd_faces(mesh, 1);
  expect_sound(mesh);
  EXPECT_EQ(counts.dropped_parts, 1);
  EXPECT_EQ(counts.removed, 2 * 162 - 4);
  // A regular tetrahedron where the last one was, its faces outwards.
  ASSERT_EQ(mesh.vertex_count(), 4);
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (std::int32_t v = 0; v < 4; ++v) centre += mesh.point(v) / 4;
  EXPECT_LT(std::min(centre.norm(), (centre - Eigen::Vector3d(5, 0, 0)).norm()), 0.01);
  for (std::int32_t f = 0; f < 4; ++f) {
    const auto& t = mesh.connectivity.triangles[f];
    const Eigen::Vector3d a = mesh.point(t[0]);
    EXPECT_GT((mesh.point(t[1]) - a).cross(mesh.point(t[2]) - a).dot(a - centre), 0);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::sqrt(mesh.length2(halfedge(f, i))), 10, 1e-5);
  }
}

TEST(RemeshingTest, OfALastTriangleATriangleStays) {
  LevelMesh mesh = level_mesh({{{0, 0, 0}, {1, 0, 0}, {0.5, 1e-9, 0}}, {{0, 1, 2}}});
  EXPECT_EQ(remove_odd_faces(mesh, 0.1), RemeshCounts{});
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::sqrt(mesh.length2(i)), 1, 1e-6);
}

TEST(RemeshingTest, RefiningHalvesTheLongestEdgesOntoTheSurface) {
  for (const bool curved : {true, false}) {
    LevelMesh mesh = level_mesh(shapes::icosphere(3));
    for (std::size_t v = 0; v < mesh.normals.size(); ++v)
      mesh.normals[v] = mesh.points[v].head<3>().normalized();
    const auto vertices = mesh.vertex_count();
    const RemeshCounts counts = refine_to(mesh, 2000, 0.01, 0.01, curved);
    expect_sound(mesh);
    EXPECT_EQ(mesh.connectivity.face_count(), 2000);
    EXPECT_EQ(counts.split, 360);
    EXPECT_EQ(mesh.vertex_count(), vertices + 360);
    EXPECT_EQ(std::ranges::count(mesh.source, kNone), 360);
    double worst = 0;
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
      worst = std::max(worst, std::abs(mesh.points[v].head<3>().norm() - 1.0));
    // Edges of 0.15: the middle of a chord lies 0.15^2 / 8 inside, of a curved edge far less.
    if (curved) {
      EXPECT_LT(worst, 2e-5);
    } else {
      EXPECT_GT(worst, 2e-3);
    }
    std::vector<double> lengths;
    for (std::int32_t f = 0; f < mesh.connectivity.face_count(); ++f)
      for (int i = 0; i < 3; ++i) lengths.push_back(mesh.length2(halfedge(f, i)));
    EXPECT_LT(std::sqrt(*std::ranges::max_element(lengths)), 0.166);
  }
}

TEST(RemeshingTest, RefiningMakesNoShortEdges) {
  LevelMesh mesh = level_mesh(shapes::torus(1, 0.4, 60, 10));  // needles
  refine_to(mesh, 1000000, 0.02, 0.05);
  expect_sound(mesh);
  EXPECT_GE(shortest(mesh), 0.05);
  EXPECT_LT(mesh.connectivity.face_count(), 1000000);
}

TEST(RemeshingTest, NewVerticesComeNextToThoseTheyComeFrom) {
  LevelMesh mesh = level_mesh(shapes::icosphere(3));
  refine_to(mesh, 1400, 0.01, 0.01);
  std::int32_t last = -1;
  for (const std::int32_t source : mesh.source) {
    if (source == kNone) continue;
    EXPECT_GT(source, last);
    last = source;
  }
  EXPECT_EQ(mesh.source.front(), 0);
}

TEST(RemeshingTest, PlacesOnLevelZeroAreCarriedAlong) {
  LevelMesh mesh = level_mesh(shapes::icosphere(3));
  const std::vector<Eigen::Vector3f> before = mesh.initial_points;
  // The level itself is elsewhere by now.
  for (auto& p : mesh.points) p.head<3>() *= 2;
  refine_to(mesh, 2000, 0.01, 0.01);
  std::int64_t inserted = 0;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const Eigen::Vector3f& p = mesh.initial_points[v];
    if (mesh.source[v] != kNone) {
      EXPECT_EQ(p, before[mesh.source[v]]);
      continue;
    }
    ++inserted;
    EXPECT_NEAR(p.norm(), 1, 0.01);  // on a chord of the sphere of level 0
    EXPECT_LT((p - mesh.points[v].head<3>() / 2).norm(), 0.01);
  }
  EXPECT_EQ(inserted, 360);
}

TEST(RemeshingTest, MarksOfFilledVerticesAndFacesAreCarriedAlong) {
  LevelMesh mesh = level_mesh(shapes::icosphere(3));
  for (const auto& p : mesh.points) mesh.vertex_filled.push_back(p.z() > 0);
  for (const auto& t : mesh.connectivity.triangles)
    mesh.face_filled.push_back(mesh.vertex_filled[t[0]] & mesh.vertex_filled[t[1]] &
                               mesh.vertex_filled[t[2]]);
  refine_to(mesh, 2500, 0.01, 0.01);
  remove_odd_faces(mesh, 0.08);
  expect_sound(mesh);
  ASSERT_EQ(mesh.vertex_filled.size(), mesh.points.size());
  ASSERT_EQ(mesh.face_filled.size(), mesh.connectivity.triangles.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    if (std::abs(mesh.points[v].z()) > 0.2) {
      EXPECT_EQ(mesh.vertex_filled[v], mesh.points[v].z() > 0);
    }
  for (std::size_t f = 0; f < mesh.face_filled.size(); ++f) {
    double height = 0;
    for (const auto v : mesh.connectivity.triangles[f]) height += mesh.points[v].z() / 3;
    if (std::abs(height) > 0.3) {
      EXPECT_EQ(mesh.face_filled[f], height > 0);
    }
  }
}

}  // namespace
}  // namespace semigeo::kernels
