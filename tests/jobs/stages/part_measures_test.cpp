#include "jobs/stages/part_measures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "kernels/repair/surface_builder.hpp"
#include "kernels/surface/vertex_order.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::jobs {
namespace {

using Eigen::Vector3d;
using kernels::TriangleMesh;

kernels::LevelMesh level_mesh(const TriangleMesh& mesh) {
  kernels::LevelMesh result;
  const kernels::BuiltSurface built = kernels::build_surface(TriangleMesh(mesh));
  const kernels::Surface surface =
      kernels::reordered(built.surface, kernels::locality_order(built.surface));
  result.connectivity = surface;
  result.part = surface.part;
  result.part_count = surface.part_count;
  const Eigen::Vector3f origin = built.origin.cast<float>();
  for (const auto& p : surface.points) {
    result.points.push_back(Eigen::Vector4f::Zero());
    result.points.back().head<3>() = p + origin;
  }
  return result;
}

std::vector<PartMeasure> measured(const TriangleMesh& mesh, int threads = 2,
                                  double edge_limit = std::numeric_limits<double>::infinity()) {
  engine::Workers workers(threads);
  engine::Observer observer;
  return measure_parts(level_mesh(mesh), edge_limit, {workers, observer, {}});
}

TriangleMesh moved(TriangleMesh mesh, double factor, const Vector3d& shift) {
  for (auto& p : mesh.points) p = factor * p + shift;
  return mesh;
}

TEST(PartMeasuresTest, OfASphere) {
  const PartMeasure sphere = measured(moved(shapes::icosphere(5), 2, {7, -3, 1})).at(0);
  EXPECT_EQ(sphere.faces, 20480);
  EXPECT_EQ(sphere.edges, 30720);
  EXPECT_EQ(sphere.boundary_edges, 0);
  EXPECT_NEAR(sphere.twice_area / 2, 16 * std::numbers::pi, 0.02);
  EXPECT_NEAR(sphere.volume(), 32.0 / 3 * std::numbers::pi, 0.03);
  EXPECT_NEAR(sphere.radius_of_gyration(), 2, 1e-4);
  EXPECT_LT((sphere.centroid() - Vector3d(7, -3, 1)).norm(), 1e-4);
}

TEST(PartMeasuresTest, AnOpenPartAndAFoldedOneEncloseNothing) {
  const PartMeasure sheet = measured(moved(shapes::plane(2, 10), 1, {0, 0, 5})).at(0);
  EXPECT_EQ(sheet.volume(), 0);
  EXPECT_EQ(sheet.boundary_edges, 40);
  TriangleMesh thin = shapes::cube(1, 4);
  for (auto& p : thin.points) p.z() *= 1e-5;
  EXPECT_EQ(measured(thin).at(0).volume(), 0);
}

TEST(PartMeasuresTest, NoiseAddsToAreaAndEdgesButNotToSize) {
  const PartMeasure smooth = measured(shapes::icosphere(5)).at(0);
  TriangleMesh mesh = shapes::icosphere(5);
  shapes::add_noise(mesh, 0.01, 4);
  const PartMeasure rough = measured(mesh).at(0);
  EXPECT_GT(rough.mean_edge_length(), 1.05 * smooth.mean_edge_length());
  EXPECT_NEAR(rough.radius_of_gyration() / smooth.radius_of_gyration(), 1, 5e-4);
  EXPECT_NEAR(std::cbrt(rough.volume() / smooth.volume()), 1, 5e-4);
}

TEST(PartMeasuresTest, OutliersChangeNeitherEdgesNorRadius) {
  const PartMeasure sphere = measured(shapes::icosphere(5)).at(0);
  TriangleMesh mesh = shapes::icosphere(5);
  mesh.points[1000] *= 1e4;
  EXPECT_GT(measured(mesh).at(0).radius_of_gyration(), 90);
  const PartMeasure spiked = measured(mesh, 2, 1).at(0);
  EXPECT_EQ(spiked.edges, sphere.edges - 6);
  EXPECT_NEAR(spiked.mean_edge_length() / sphere.mean_edge_length(), 1, 1e-4);
  EXPECT_NEAR(spiked.radius_of_gyration(), 1, 1e-4);
  EXPECT_EQ(spiked.volume(), 0);
}

TEST(PartMeasuresTest, ScaledIsWhatTheScaledPartMeasures) {
  for (const TriangleMesh& mesh : {shapes::torus(1, 0.4, 40, 20, 0.5), shapes::hemisphere(3)}) {
    const PartMeasure plain = measured(moved(mesh, 1, {3, 1, -2})).at(0);
    const Vector3d centre = plain.centroid();
    const PartMeasure wanted =
        measured(moved(moved(mesh, 1, Vector3d(3, 1, -2) - centre), 1.7, centre)).at(0);
    const PartMeasure scaled = plain.scaled(1.7);
    EXPECT_NEAR(scaled.mean_edge_length(), wanted.mean_edge_length(), 1e-6);
    EXPECT_NEAR(scaled.twice_area, wanted.twice_area, 1e-5 * wanted.twice_area);
    EXPECT_NEAR(scaled.radius_of_gyration(), wanted.radius_of_gyration(), 1e-5);
    EXPECT_NEAR(scaled.volume(), wanted.volume(), 1e-5 * (1 + wanted.volume()));
    EXPECT_LT((scaled.centroid() - wanted.centroid()).norm(), 1e-5);
  }
}

TEST(PartMeasuresTest, PartsApartAndTheSameOnAnyNumberOfThreads) {
  TriangleMesh two = shapes::icosphere(5);
  const auto n = static_cast<std::int32_t>(two.points.size());
  const TriangleMesh other = moved(shapes::cube(1, 30), 3, {9, 0, 0});
  for (const auto& p : other.points) two.points.push_back(p);
  for (const auto& t : other.triangles) two.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  const auto one = measured(two, 1);
  ASSERT_EQ(one.size(), 2);
  EXPECT_NEAR(one[1].volume(), 27, 1e-4);
  const auto more = measured(two, 4);
  for (int part = 0; part < 2; ++part) {
    EXPECT_EQ(one[part].edge_length, more[part].edge_length);
    EXPECT_EQ(one[part].volume(), more[part].volume());
    EXPECT_EQ(one[part].centroid(), more[part].centroid());
  }
}

}  // namespace
}  // namespace semigeo::jobs
