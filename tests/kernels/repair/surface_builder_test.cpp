#include "kernels/repair/surface_builder.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "tests/support/shapes.hpp"
#include "tests/support/soundness.hpp"

namespace semigeo::kernels {
namespace {

using tests::fault_of;

TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

TEST(SurfaceBuilderTest, ACleanMeshStaysAsItIs) {
  const auto built = build_surface(tetrahedron());
  EXPECT_EQ(built.repairs, SurfaceRepairs{});
  EXPECT_EQ(built.surface.triangles, tetrahedron().triangles);
  EXPECT_EQ(built.surface.part_count, 1);
  EXPECT_TRUE(built.origin.isZero(0));
  EXPECT_EQ(fault_of(built.surface), "");
}

TEST(SurfaceBuilderTest, WeldsASoupInOrderOfAppearance) {
  TriangleMesh soup;
  for (const auto& t : tetrahedron().triangles) {
    for (const auto v : t) soup.points.push_back(tetrahedron().points[v]);
    const auto n = static_cast<std::int32_t>(soup.points.size());
    soup.triangles.push_back({n - 3, n - 2, n - 1});
  }
  soup.points[4] = -soup.points[4] * 0.0;  // not a corner of the tetrahedron any more, but ...
  soup.points[4] = {1, -0.0, 0};           // ... vertex 1 again, with a negative zero
  const auto built = build_surface(std::move(soup));
  EXPECT_EQ(built.repairs.welded_vertices, 8);
  EXPECT_EQ(built.surface.vertex_count(), 4);
  EXPECT_EQ(built.surface.triangles[0], (std::array<std::int32_t, 3>{0, 1, 2}));
  EXPECT_EQ(fault_of(built.surface), "");
}

TEST(SurfaceBuilderTest, CountsWhatAHalfEdgeMeshCannotHold) {
  TriangleMesh mesh = tetrahedron();
  mesh.points.push_back({5, 5, 5});     // isolated
  mesh.points.push_back({-1, -1, -1});  // third face on edge 0 - 1
  mesh.triangles.push_back({0, 1, 1});  // degenerate
  mesh.triangles.push_back({3, 1, 0});  // duplicate, turned
  mesh.triangles.push_back({0, 1, 5});  // non-manifold
  const auto built = build_surface(std::move(mesh));
  SurfaceRepairs expected;
  expected.degenerate_faces = 1;
  expected.duplicate_faces = 1;
  expected.nonmanifold_edges = 1;
  expected.split_vertices = 2;
  expected.isolated_vertices = 1;
  EXPECT_EQ(built.repairs, expected);
  EXPECT_EQ(built.surface.face_count(), 5);  // the fin is a part of its own
  EXPECT_EQ(built.surface.part_count, 2);
  EXPECT_EQ(fault_of(built.surface), "");
}

TEST(SurfaceBuilderTest, OrientsByMajority) {
  TriangleMesh mesh = shapes::icosphere(2);
  std::int64_t turned = 0;
  for (std::size_t f = 0; f < mesh.triangles.size(); f += 3, ++turned)
    std::swap(mesh.triangles[f][0], mesh.triangles[f][1]);
  const auto built = build_surface(std::move(mesh));
  EXPECT_EQ(built.repairs.flipped_faces, turned);
  EXPECT_EQ(built.repairs.nonmanifold_edges, 0);
  for (const auto& t : built.surface.triangles) {
    const auto& p = built.surface.points;
    EXPECT_GT(p[t[0]].dot(Eigen::Vector3f(p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]])), 0);
  }
}

TEST(SurfaceBuilderTest, SplitsAVertexWhereTwoFansTouch) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}},
                    {{0, 1, 2}, {0, 3, 4}}};
  const auto built = build_surface(std::move(mesh));
  EXPECT_EQ(built.repairs.split_vertices, 1);
  EXPECT_EQ(built.surface.vertex_count(), 6);
  EXPECT_EQ(built.surface.points[5], built.surface.points[0]);
  EXPECT_EQ(built.surface.part_count, 2);
  EXPECT_EQ(built.surface.part, (std::vector<std::int32_t>{0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(fault_of(built.surface), "");
}

TEST(SurfaceBuilderTest, AMoebiusStripIsCutNotRefused) {
  TriangleMesh mesh;
  constexpr int kLength = 12;
  for (int i = 0; i < kLength; ++i) {
    const double s = 2 * M_PI * i / kLength, t = s / 2;
    for (const double w : {-0.3, 0.3})
      mesh.points.emplace_back((1 + w * std::cos(t)) * std::cos(s),
                               (1 + w * std::cos(t)) * std::sin(s), w * std::sin(t));
  }
  for (std::int32_t i = 0; i < kLength; ++i) {
    const std::int32_t a = 2 * i, b = a + 1;
    const bool last = i == kLength - 1;
    const std::int32_t c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({b, c, d});
  }
  const auto built = build_surface(std::move(mesh));
  EXPECT_GE(built.repairs.nonmanifold_edges, 1);
  EXPECT_EQ(built.surface.face_count(), 2 * kLength);
  EXPECT_EQ(fault_of(built.surface), "");
}

TEST(SurfaceBuilderTest, FarFromTheOriginKeepsItsDetail) {
  TriangleMesh mesh = shapes::icosphere(3);
  const Eigen::Vector3d map(432100.25, 5712000.5, 117.75);
  for (auto& p : mesh.points) p += map;
  const auto built = build_surface(std::move(mesh));
  EXPECT_FALSE(built.origin.isZero(0));
  const auto original = shapes::icosphere(3).points;
  for (std::size_t v = 0; v < original.size(); ++v)
    EXPECT_LT((built.surface.points[v].cast<double>() + built.origin - map - original[v]).norm(),
              1e-6);
}

/// A box of n x n x n cells from the corner `low`, of edge length 1 altogether.
TriangleMesh box(const Eigen::Vector3d& low, int n = 2) {
  TriangleMesh mesh = shapes::cube(1, n);
  for (auto& p : mesh.points) p += low + Eigen::Vector3d::Constant(0.5);
  return mesh;
}

void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto first = static_cast<std::int32_t>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), other.points.begin(), other.points.end());
  for (const auto& t : other.triangles)
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

/// The same triangles, each with corners of its own.
TriangleMesh soup_of(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const auto& t : mesh.triangles) {
    const auto n = static_cast<std::int32_t>(soup.points.size());
    for (const auto v : t) soup.points.push_back(mesh.points[v]);
    soup.triangles.push_back({n, n + 1, n + 2});
  }
  return soup;
}

/// The same places with one vertex each.
TriangleMesh indexed(const TriangleMesh& mesh) {
  TriangleMesh result;
  std::map<std::array<double, 3>, std::int32_t> index;
  for (const auto& t : mesh.triangles) {
    std::array<std::int32_t, 3> corners{};
    for (int i = 0; i < 3; ++i) {
      const auto& p = mesh.points[t[i]];
      const auto [at, is_new] =
          index.emplace(std::array{p.x(), p.y(), p.z()}, std::ssize(result.points));
      if (is_new) result.points.push_back(p);
      corners[i] = at->second;
    }
    result.triangles.push_back(corners);
  }
  return result;
}

struct PartShape {
  double area = 0;
  double volume = 0;
  bool closed = true;
};

std::vector<PartShape> shapes_of(const Surface& surface) {
  std::vector<PartShape> parts(surface.part_count);
  for (std::int32_t f = 0; f < surface.face_count(); ++f) {
    const auto& t = surface.triangles[f];
    const Eigen::Vector3d a = surface.points[t[0]].cast<double>(),
                          b = surface.points[t[1]].cast<double>(),
                          c = surface.points[t[2]].cast<double>();
    PartShape& part = parts[surface.part[t[0]]];
    part.area += (b - a).cross(c - a).norm() / 2;
    part.volume += a.dot(b.cross(c)) / 6;
    for (int i = 0; i < 3; ++i) part.closed = part.closed && surface.twin[halfedge(f, i)] != kNone;
  }
  return parts;
}

void expect_unit_boxes(const BuiltSurface& built, int count, const std::string& what) {
  EXPECT_EQ(fault_of(built.surface), "") << what;
  const auto parts = shapes_of(built.surface);
  ASSERT_EQ(std::ssize(parts), count) << what;
  for (const PartShape& part : parts) {
    EXPECT_TRUE(part.closed) << what;
    EXPECT_NEAR(part.area, 6, 1e-5) << what;
    EXPECT_NEAR(part.volume, 1, 1e-5) << what;
  }
}

TEST(SurfaceBuilderTest, SolidsThatTouchComeApartWhole) {
  const std::map<std::string, Eigen::Vector3d> contacts = {{"corner", {1, 1, 1}},
                                                           {"edge", {1, 1, 0}},
                                                           {"face", {1, 0, 0}},
                                                           {"half an edge", {1, 1, 0.5}},
                                                           {"half a face", {1, 0.5, 0}}};
  for (const auto& [contact, offset] : contacts) {
    TriangleMesh mesh = box({0, 0, 0});
    append(mesh, box(offset));
    expect_unit_boxes(build_surface(TriangleMesh(mesh)), 2, contact + ", vertices apart");
    expect_unit_boxes(build_surface(soup_of(mesh)), 2, contact + ", soup");
    if (contact != "face" && contact != "half a face")
      expect_unit_boxes(build_surface(indexed(mesh)), 2, contact + ", shared vertices");
  }
}

TEST(SurfaceBuilderTest, CellsKeepTheirWallsOnBothSides) {
  TriangleMesh cells;
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 3; ++y)
      for (int z = 0; z < 3; ++z)
        append(cells,
               box({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}));
  expect_unit_boxes(build_surface(TriangleMesh(cells)), 27, "vertices apart");
  expect_unit_boxes(build_surface(soup_of(cells)), 27, "soup");
}

TEST(SurfaceBuilderTest, SheetsOfABookKeepTheirArea) {
  TriangleMesh book;
  for (const double angle : {0.0, 1.0, 2.5, 4.0}) {
    TriangleMesh sheet = shapes::plane(1, 4);
    for (auto& p : sheet.points) {
      const double x = p.x() + 0.5;
      p = {x * std::cos(angle), p.y(), x * std::sin(angle)};
      if (x == 0) p.x() = p.z() = 0;  // the spine
    }
    append(book, sheet);
  }
  for (const bool shared : {false, true}) {
    const auto built = build_surface(shared ? indexed(book) : TriangleMesh(book));
    EXPECT_EQ(fault_of(built.surface), "");
    double area = 0;
    for (const PartShape& part : shapes_of(built.surface)) area += part.area;
    EXPECT_NEAR(area, 4, 1e-5);
    EXPECT_EQ(built.repairs.duplicate_faces, 0);
  }
}

TEST(SurfaceBuilderTest, TheBackOfATwoSidedSheetIsADuplicate) {
  TriangleMesh sheet = shapes::saddle(2, 6);
  const std::int64_t faces = std::ssize(sheet.triangles);
  for (std::int64_t f = 0; f < faces; ++f) {
    const auto t = sheet.triangles[f];
    sheet.triangles.push_back({t[0], t[2], t[1]});
  }
  for (const bool soup : {false, true}) {
    const auto built = build_surface(soup ? soup_of(sheet) : TriangleMesh(sheet));
    EXPECT_EQ(built.repairs.duplicate_faces, faces);
    EXPECT_EQ(built.surface.face_count(), faces);
    EXPECT_EQ(built.surface.part_count, 1);
    EXPECT_EQ(fault_of(built.surface), "");
  }
}

TEST(SurfaceBuilderTest, AStrayVertexDoesNotDecideTheOrigin) {
  TriangleMesh mesh = shapes::icosphere(3);
  const Eigen::Vector3d map(500000.25, 5400000.5, 300.75);
  for (auto& p : mesh.points) p += map;
  mesh.points.emplace_back(0, 0, 0);
  const auto built = build_surface(std::move(mesh));
  EXPECT_EQ(built.repairs.isolated_vertices, 1);
  EXPECT_LT(built.coordinate_step, 1e-6);
  const auto original = shapes::icosphere(3).points;
  for (std::size_t v = 0; v < original.size(); ++v)
    EXPECT_LT((built.surface.points[v].cast<double>() + built.origin - map - original[v]).norm(),
              1e-6);
}

TEST(SurfaceBuilderTest, CornersThatDifferByRoundingAreOneSurface) {
  for (const double radius : {1.0, 50.0, 1e-3}) {
    TriangleMesh soup = soup_of(shapes::icosphere(3, radius));
    std::mt19937 random(5);
    std::uniform_real_distribution<double> rounding(-1e-11 * radius, 1e-11 * radius);
    for (auto& p : soup.points)
      p += Eigen::Vector3d(rounding(random), rounding(random), rounding(random));
    const auto built = build_surface(std::move(soup));
    EXPECT_EQ(built.surface.vertex_count(), 642) << radius;
    EXPECT_EQ(built.surface.part_count, 1) << radius;
    EXPECT_TRUE(shapes_of(built.surface)[0].closed) << radius;
    EXPECT_EQ(fault_of(built.surface), "");
  }
}

TEST(SurfaceBuilderTest, CornersThatDifferInTheLastDecimalAreOneSurface) {
  TriangleMesh soup = soup_of(shapes::icosphere(3, 50));
  std::mt19937 random(5);
  for (auto& p : soup.points)
    for (int c = 0; c < 3; ++c)
      p[c] = std::round(p[c] * 1000 + std::uniform_real_distribution<>(-0.4, 0.4)(random)) / 1000;
  const auto built = build_surface(std::move(soup));
  EXPECT_GT(built.repairs.gap_vertices, 100);
  EXPECT_EQ(built.surface.vertex_count(), 642);
  EXPECT_TRUE(shapes_of(built.surface)[0].closed);
}

TEST(SurfaceBuilderTest, AThinWallStaysAWall) {
  // Two sheets nearer to each other than the numbers are precise. Their rims are not a gap.
  TriangleMesh wall = shapes::plane(1000, 10);
  for (auto& p : wall.points) p.z() = 0.1 * std::round(p.x() / 100);
  TriangleMesh back = wall;
  for (auto& p : back.points) p.z() += 0.1;
  for (auto& t : back.triangles) std::swap(t[1], t[2]);
  append(wall, back);
  const auto built = build_surface(std::move(wall));
  EXPECT_EQ(built.repairs.gap_vertices, 0);
  EXPECT_EQ(built.surface.face_count(), 400);
  EXPECT_EQ(built.surface.part_count, 2);
}

TEST(SurfaceBuilderTest, IntegerGridsAreNotRounded) {
  TriangleMesh a = shapes::plane(10, 10), b = a;  // edges of length 1, a gap of 1
  for (auto& p : b.points) p.x() += 11;
  append(a, b);
  const auto built = build_surface(std::move(a));
  EXPECT_EQ(built.repairs.gap_vertices, 0);
  EXPECT_EQ(built.surface.part_count, 2);
}

TEST(SurfaceBuilderTest, ClosedPartsFaceOutwards) {
  TriangleMesh mesh = shapes::icosphere(3);
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  TriangleMesh far_out = mesh;  // one vertex on the wrong side, so far that the volume is positive
  far_out.points[100] *= -500;
  TriangleMesh good = shapes::icosphere(2, 0.5);
  for (auto& p : good.points) p.x() += 3;
  append(mesh, good);
  const auto built = build_surface(std::move(mesh));
  EXPECT_EQ(built.repairs.turned_parts, 1);
  EXPECT_EQ(fault_of(built.surface), "");
  for (const PartShape& part : shapes_of(built.surface)) EXPECT_GT(part.volume, 0);
  EXPECT_EQ(build_surface(std::move(far_out)).repairs.turned_parts, 1);
}

// The majority of an open part's triangles may face inwards; its normals tell.
TEST(SurfaceBuilderTest, OpenPartsFollowTheNormalsOfTheMesh) {
  for (const bool inwards : {false, true}) {
    TriangleMesh mesh = shapes::hemisphere(3);
    TriangleMesh other = shapes::hemisphere(2);  // of the other orientation
    for (auto& p : other.points) p.x() += 5;
    for (auto& t : other.triangles) std::swap(t[1], t[2]);
    const std::size_t first = mesh.points.size();
    append(mesh, other);
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      const Eigen::Vector3d centre(v < first ? 0 : 5, 0, 0);
      mesh.normals.emplace_back(((mesh.points[v] - centre) * (inwards ? -2 : 2)).cast<float>());
    }
    const auto built = build_surface(std::move(mesh));
    EXPECT_EQ(built.repairs.turned_parts, 1);
    EXPECT_EQ(fault_of(built.surface), "");
    for (const auto& t : built.surface.triangles) {
      const auto& p = built.surface.points;
      const Eigen::Vector3f centre(p[t[0]].x() > 2 ? 5 : 0, 0, 0);
      const float out = (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).dot(p[t[0]] - centre);
      EXPECT_EQ(out < 0, inwards);
    }
  }
}

// Split and welded vertices keep their normals, vertices without faces do not count.
TEST(SurfaceBuilderTest, NormalsFollowTheirVertices) {
  TriangleMesh mesh{{{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {-1, 0, 0}, {0, -1, 0}},
                    {{1, 2, 3}, {4, 5, 6}}};
  mesh.normals.assign(7, {0, 0, -1});
  mesh.normals[0] = {0, 0, 9};
  const auto built = build_surface(std::move(mesh));
  EXPECT_EQ(built.repairs.welded_vertices, 1);
  EXPECT_EQ(built.repairs.split_vertices, 1);
  EXPECT_EQ(built.repairs.turned_parts, 2);
}

TEST(SurfaceBuilderTest, CavitiesKeepFacingTheOtherWay) {
  TriangleMesh mesh = shapes::icosphere(3);
  TriangleMesh cavity = shapes::icosphere(2, 0.3);
  for (auto& t : cavity.triangles) std::swap(t[1], t[2]);
  TriangleMesh beside = cavity;  // in the box of the sphere, but outside of it
  for (auto& p : beside.points) p = 0.2 * p + Eigen::Vector3d(0.85, 0.85, 0);
  append(mesh, cavity);
  append(mesh, beside);
  const auto built = build_surface(std::move(mesh));
  EXPECT_EQ(built.repairs.turned_parts, 1);
  const auto parts = shapes_of(built.surface);
  EXPECT_GT(parts[0].volume, 0);
  EXPECT_LT(parts[1].volume, 0);
  EXPECT_GT(parts[2].volume, 0);
}

// A hollow ball with a ball in its cavity, of which some parts face the wrong way in the file.
TEST(SurfaceBuilderTest, BodiesThatAreInsideOutAreTurnedAsAWhole) {
  struct Case {
    std::array<bool, 3> outward_in_file;
    int turned;
    std::array<bool, 3> outward;
  };
  for (const Case& c : {Case{{true, false, true}, 0, {true, false, true}},
                        Case{{false, true, false}, 3, {true, false, true}},
                        Case{{false, false, true}, 1, {true, false, true}},
                        Case{{true, true, true}, 0, {true, true, true}}}) {
    TriangleMesh mesh;
    for (int i = 0; i < 3; ++i) {
      TriangleMesh ball = shapes::icosphere(2, 1.0 / (1 + i));
      if (!c.outward_in_file[i])
        for (auto& t : ball.triangles) std::swap(t[1], t[2]);
      append(mesh, ball);
    }
    const auto built = build_surface(std::move(mesh));
    EXPECT_EQ(built.repairs.turned_parts, c.turned);
    const auto parts = shapes_of(built.surface);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(parts[i].volume > 0, c.outward[i]) << i;
  }
}

TEST(SurfaceBuilderTest, NothingLeftIsAnEmptySurface) {
  const auto built = build_surface({{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 1}}});
  EXPECT_EQ(built.surface.face_count(), 0);
  EXPECT_EQ(built.surface.vertex_count(), 0);
  EXPECT_EQ(built.repairs.degenerate_faces, 1);
  EXPECT_EQ(built.repairs.isolated_vertices, 2);
}

/// Cells of the gap's width that are counted from the origin do not fit into 64 bits.
TEST(SurfaceBuilderTest, GapsMayBeAsNarrowAsNothingBesideTheSurface) {
  const TriangleMesh far = {.points = {{0, 0, 0}, {1e25, 0, 0}, {0, 1e25, 0}, {1e25, 1e25, 1}},
                            .triangles = {{0, 1, 2}, {1, 3, 2}}};
  for (const double distance : {1e-3, 1e-300}) {
    const BuiltSurface built = build_surface(TriangleMesh(far), {.distance = distance});
    EXPECT_EQ(built.surface.face_count(), 2);
    EXPECT_EQ(built.repairs.gap_vertices, 0);
  }
}

}  // namespace
}  // namespace semigeo::kernels
