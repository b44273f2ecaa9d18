#include "jobs/stages/evolving_surface.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/patch/gaussian.hpp"
#include "tests/jobs/stages/evolve_mesh.hpp"
#include "tests/support/quantile.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::jobs {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using kernels::TriangleMesh;
using shapes::rough_torus;
using tests::median;

/// Median |value - truth| / |truth| over the valid vertices.
double median_error(const std::vector<float>& values, const LevelFields& level, double truth) {
  std::vector<double> errors;
  for (std::size_t v = 0; v < values.size(); ++v)
    if (level.patch_completeness[v] > 0) errors.push_back(std::abs(values[v] / truth - 1));
  return median(std::move(errors));
}

bool all_finite(const LevelFields& level) {
  for (std::size_t v = 0; v < level.points.size(); ++v)
    if (!level.points[v].allFinite() || !level.normals[v].allFinite() ||
        !std::isfinite(level.gaussian_curvature[v]) || !std::isfinite(level.mean_curvature[v]) ||
        !std::isfinite(level.patch_completeness[v]))
      return false;
  return true;
}

template <typename Value>
bool same_bytes(const std::vector<Value>& a, const std::vector<Value>& b) {
  return std::ranges::equal(std::as_bytes(std::span(a)), std::as_bytes(std::span(b)));
}

TriangleMesh moved(TriangleMesh mesh, const Vector3d& by) {
  for (auto& p : mesh.points) p += by;
  return mesh;
}

TriangleMesh joined(TriangleMesh a, const TriangleMesh& b) {
  const auto first = static_cast<std::int32_t>(a.points.size());
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  for (const auto& [p, q, r] : b.triangles)
    a.triangles.push_back({p + first, q + first, r + first});
  return a;
}

TriangleMesh tetrahedron(double size, const Vector3d& at) {
  return {{at, at + size * Vector3d::UnitX(), at + size * Vector3d::UnitY(),
           at + size * Vector3d::UnitZ()},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

TEST(EvolvingSurfaceTest, APlaneStaysAPlane) {
  TriangleMesh mesh = shapes::plane(2, 20);
  shapes::add_noise(mesh, 0.01, 3);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()));
  for (auto& p : mesh.points) p = turn * Vector3d(p.x(), p.y(), 0);
  const Vector3d normal = turn * Vector3d::UnitZ();
  for (const bool curved : {true, false}) {
    const EvolvedMesh evolved = evolve_mesh(mesh, 8, {.curved = curved});
    for (const LevelFields& level : evolved.levels)
      for (std::size_t v = 0; v < level.points.size(); ++v) {
        ASSERT_NEAR(level.points[v].cast<double>().dot(normal), 0, 1e-6);
        ASSERT_NEAR(level.normals[v].cast<double>().dot(normal), 1, 1e-6);
        ASSERT_NEAR(level.gaussian_curvature[v], 0, 1e-3);
        ASSERT_NEAR(level.mean_curvature[v], 0, 1e-3);
      }
    // The rim neither crept inwards nor flew off.
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
      EXPECT_LT((evolved.point(8, v) - mesh.points[v]).norm(), 0.2);
  }
}

// Every pass shrinks it by about step^2 / r; the rescaling takes that back, so each level is the
// same sphere.
TEST(EvolvingSurfaceTest, ASphereStaysASphere) {
  const EvolvedMesh evolved = evolve_mesh(shapes::icosphere(4, 2), 8);
  const double step = evolved.levels[0].step / 2;  // for radius 1
  for (const LevelFields& level : evolved.levels) {
    double nearest = 3, farthest = 0;
    for (const Vector3f& p : level.points) {
      nearest = std::min<double>(nearest, p.norm());
      farthest = std::max<double>(farthest, p.norm());
    }
    EXPECT_NEAR(nearest, 2, 3e-4);
    EXPECT_NEAR(farthest, 2, 3e-4);
    EXPECT_LT(median_error(level.gaussian_curvature, level, 0.25), 0.1 * step * step);
    EXPECT_LT(median_error(level.mean_curvature, level, -0.5), 0.05 * step * step);
    EXPECT_EQ(*std::ranges::min_element(level.patch_completeness), 1);
    for (std::size_t v = 0; v < level.points.size(); ++v)
      ASSERT_GT(level.normals[v].dot(level.points[v].normalized()), 0.9999f);
  }
}

// Level 1 is the smoothed surface, enlarged about its centroid to the first mean edge length (5.1).
TEST(EvolvingSurfaceTest, RestoringEdgesEnlargesAboutTheCentroid) {
  const EvolvedMesh plain =
      evolve_mesh(rough_torus(), 1, {.rescale = Rescale::kNone, .remesh = false});
  const EvolvedMesh restored =
      evolve_mesh(rough_torus(), 1, {.rescale = Rescale::kEdges, .remesh = false});
  double area = 0;
  Vector3d centre = Vector3d::Zero();
  for (const auto& t : plain.surface.triangles) {
    const Vector3d a = plain.point(1, t[0]), b = plain.point(1, t[1]), c = plain.point(1, t[2]);
    const double face = (b - a).cross(c - a).norm();
    area += face;
    centre += face * (a + b + c) / 3;
  }
  centre /= area;
  const double factor = plain.levels[0].mean_edge_length / plain.levels[1].mean_edge_length;
  EXPECT_GT(factor, 1.01);
  for (std::size_t v = 0; v < plain.levels[1].points.size(); ++v) {
    const Vector3d expected = centre + factor * (plain.point(1, v) - centre);
    EXPECT_LT((restored.point(1, v) - expected).norm(), 2e-6);
  }
}

// Noise lengthens edges; restoring their mean then blows the surface up. It leaves volumes alone.
TEST(EvolvingSurfaceTest, ANoisySphereKeepsItsSizeUnlessItsEdgesAreRestored) {
  TriangleMesh mesh = shapes::icosphere(5);
  shapes::add_noise(mesh, 0.008, 11);
  const auto radius = [](const EvolvedMesh& evolved) {
    double mean = 0;
    for (const Vector3f& p : evolved.levels[4].points) mean += p.norm();
    return mean / static_cast<double>(evolved.levels[4].points.size());
  };
  const EvolvedMesh plain = evolve_mesh(mesh, 4, {.rescale = Rescale::kNone});
  const double step = plain.levels[0].step;
  EXPECT_NEAR(radius(plain), std::sqrt(1 - 2 * 4 * step * step), 2e-3);
  EXPECT_GT(radius(evolve_mesh(mesh, 4, {.rescale = Rescale::kEdges})), 1.03);
  EXPECT_NEAR(radius(evolve_mesh(mesh, 4)), 1, 1e-3);
}

double mean_edge_length(const TriangleMesh& mesh) {
  return kernels::mean_edge_length(kernels::build_surface(TriangleMesh(mesh)).surface);
}

// Their steps are one, so parts are as if alone only when alone they would have the same step.
TEST(EvolvingSurfaceTest, PartsEvolveIndependently) {
  const TriangleMesh torus = rough_torus();
  TriangleMesh other = shapes::icosphere(3);  // shrinks by another factor
  shapes::add_noise(other, 0.01, 2);
  const double factor = mean_edge_length(torus) / mean_edge_length(other);
  for (auto& p : other.points) p *= factor;
  const Vector3d away(0, 0, 2);
  const EvolvedMesh both = evolve_mesh(joined(torus, moved(other, away)), 5, {.remesh = false});
  ASSERT_EQ(both.surface.part_count, 2);
  const EvolvedMesh alone = evolve_mesh(torus, 5, {.remesh = false});
  const EvolvedMesh other_alone = evolve_mesh(moved(other, away), 5, {.remesh = false});
  for (std::size_t k = 0; k <= 5; ++k) {
    const std::size_t n = alone.levels[k].points.size();
    EXPECT_NEAR(both.levels[k].scale, alone.levels[k].scale, 1e-6);
    std::vector<double> first, second;
    for (std::size_t v = 0; v < n; ++v)
      first.push_back((both.point(k, v) - alone.point(k, v)).norm());
    for (std::size_t v = 0; v < other.points.size(); ++v)
      second.push_back((both.point(k, n + v) - other_alone.point(k, v)).norm());
    EXPECT_LT(*std::ranges::max_element(first), 5e-4) << "level " << k;
    EXPECT_LT(*std::ranges::max_element(second), 5e-4) << "level " << k;
    EXPECT_LT(median(std::move(first)), 5e-6) << "level " << k;
    EXPECT_LT(median(std::move(second)), 5e-6) << "level " << k;
  }
}

TEST(EvolvingSurfaceTest, ScaleIsTheSmoothingSoFarAndTheStep) {
  const double variance_of_a_pass = kernels::gaussian_filters().variance;
  for (const double factor : {0.5, 1.0, 2.0}) {
    const EvolvedMesh evolved = evolve_mesh(
        rough_torus(), 12, {.rescale = Rescale::kEdges, .remesh = false, .step_factor = factor});
    double variance = 0, previous = 0;
    for (const LevelFields& level : evolved.levels) {
      EXPECT_NEAR(level.step, factor * evolved.levels[0].mean_edge_length, 1e-12);
      EXPECT_NEAR(level.scale, std::sqrt(variance + level.step * level.step), 1e-9);
      EXPECT_GT(level.scale, previous);
      // One closed part: the rescaling gives every level the first mean edge length.
      EXPECT_NEAR(level.mean_edge_length, evolved.levels[0].mean_edge_length, 1e-6);
      previous = level.scale;
      variance += variance_of_a_pass * level.step * level.step;
    }
  }
}

// Steps grow with the scale already reached, two levels double it, and nothing is rescaled.
TEST(EvolvingSurfaceTest, OctavesDoubleTheScaleInTwoLevels) {
  const EvolvedMesh evolved =
      evolve_mesh(shapes::icosphere(5), 5, {.schedule = Schedule::kOctaves});
  const double h = evolved.levels[0].mean_edge_length;
  const double steps[] = {1, 1, std::sqrt(2), 2, std::sqrt(8), 4};
  double radius = 1;
  for (int k = 0; k <= 5; ++k) {
    const LevelFields& level = evolved.levels[k];
    EXPECT_NEAR(level.step / h, steps[k], 0.01) << k;
    EXPECT_NEAR(level.scale / h, std::sqrt(2.0) * (k == 0 ? std::sqrt(0.5) : steps[k]), 0.01) << k;
    // A sphere shrinks as mean curvature flow has it: r r' = -1 per unit of variance.
    double mean = 0;
    for (const Vector3f& p : level.points) mean += p.norm() / level.points.size();
    EXPECT_NEAR(mean, radius, 2e-3) << k;
    EXPECT_LT(median_error(level.mean_curvature, level, -1 / mean), 2e-3);
    radius = std::sqrt(radius * radius - 2 * level.step * level.step);
  }
}

TEST(EvolvingSurfaceTest, ALargerStepSmoothsMore) {
  const auto roughness = [](double factor) {
    TriangleMesh mesh = shapes::icosphere(4);
    shapes::add_noise(mesh, 0.003, 5);
    const EvolvedMesh evolved = evolve_mesh(mesh, 1, {.step_factor = factor});
    return median_error(evolved.levels[1].mean_curvature, evolved.levels[1], -1);
  };
  EXPECT_LT(roughness(1), 0.5 * roughness(0.5));
  EXPECT_LT(roughness(2), 0.5 * roughness(1));
}

// Flat triangles lie inside a sphere by as much as its curvature shows, at every resolution.
TEST(EvolvingSurfaceTest, FlatFacesOverestimateCurvature) {
  for (const bool curved : {true, false}) {
    const EvolvedMesh evolved = evolve_mesh(shapes::icosphere(4), 3, {.curved = curved});
    for (const LevelFields& level : evolved.levels) {
      std::vector<double> gaussian(level.gaussian_curvature.begin(),
                                   level.gaussian_curvature.end());
      const double error = median(std::move(gaussian)) - 1;
      if (curved) {
        EXPECT_NEAR(error, 0, 0.001);
      } else {
        EXPECT_NEAR(error, 0.050, 0.005);
      }
    }
  }
}

// On an uneven mesh angle-weighted normals alone make the error half as large again.
TEST(EvolvingSurfaceTest, LevelZeroHasTheNormalsOfTheConvolvedSurface) {
  TriangleMesh mesh = shapes::torus(1, 0.4, 200, 100);
  shapes::add_noise(mesh, 0.004, 4);  // along the surface: each vertex is put back on it
  for (auto& p : mesh.points) {
    const Vector3d ring = Vector3d(p.x(), p.y(), 0).normalized();
    p = ring + 0.4 * (p - ring).normalized();
  }
  const EvolvedMesh evolved = evolve_mesh(mesh, 0);
  const LevelFields& level = evolved.levels[0];
  std::vector<double> errors;
  for (std::size_t v = 0; v < level.points.size(); ++v) {
    const double ring = std::hypot(level.points[v].x(), level.points[v].y());
    const double truth = (ring - 1) / 0.4 / (0.4 * ring);
    errors.push_back(std::abs(level.gaussian_curvature[v] / truth - 1));
  }
  EXPECT_LT(median(std::move(errors)), 0.0015);
}

/// Edges from each vertex to the nearest boundary vertex.
std::vector<int> distances_to_rim(const kernels::Surface& surface) {
  constexpr int kFar = 1000;
  std::vector<int> distance(surface.points.size(), kFar);
  for (std::int32_t v = 0; v < surface.vertex_count(); ++v)
    if (surface.on_boundary(v)) distance[v] = 0;
  for (int ring = 1; ring < 12; ++ring)
    for (const auto& t : surface.triangles)
      for (const auto v : t)
        for (const auto w : t)
          if (distance[w] == ring - 1) distance[v] = std::min(distance[v], ring);
  return distance;
}

// Two passes more for the normals there, and a fit of degree 4 where noise allows it.
TEST(EvolvingSurfaceTest, RimsOfAHemisphereKeepTheirCurvature) {
  const EvolvedMesh evolved = evolve_mesh(shapes::hemisphere(5), 0);
  const LevelFields& level = evolved.levels[0];
  const std::vector<int> distance = distances_to_rim(evolved.surface);
  const auto error = [&](int from, int to) {
    std::vector<double> errors;
    for (std::size_t v = 0; v < distance.size(); ++v)
      if (distance[v] >= from && distance[v] <= to && level.patch_completeness[v] > 0)
        errors.push_back(std::abs(level.gaussian_curvature[v] - 1));
    EXPECT_GT(errors.size(), 50u);
    return median(std::move(errors));
  };
  EXPECT_LT(error(8, 1000), 1e-4);
  EXPECT_LT(error(4, 4), 1.5e-4);
  EXPECT_LT(error(2, 2), 2e-4);
  EXPECT_LT(error(1, 1), 6e-4);
  EXPECT_LT(error(0, 0), 8e-3);
}

TEST(EvolvingSurfaceTest, EveryNumberOfThreadsGivesTheSame) {
  // More faces and vertices than one block of either, in several parts, with a rim.
  const TriangleMesh mesh =
      joined(joined(shapes::torus(1, 0.4, 120, 60, 0.3), moved(shapes::plane(2, 40), {0, 0, 3})),
             tetrahedron(0.01, {5, 0, 0}));
  const EvolvedMesh one = evolve_mesh(mesh, 4, {}, 1);
  for (const int threads : {2, 4}) {
    const EvolvedMesh more = evolve_mesh(mesh, 4, {}, threads);
    for (std::size_t k = 0; k < one.levels.size(); ++k) {
      const LevelFields& a = one.levels[k];
      const LevelFields& b = more.levels[k];
      EXPECT_TRUE(same_bytes(a.points, b.points)) << threads << " threads, level " << k;
      EXPECT_TRUE(same_bytes(a.normals, b.normals));
      EXPECT_TRUE(same_bytes(a.gaussian_curvature, b.gaussian_curvature));
      EXPECT_TRUE(same_bytes(a.mean_curvature, b.mean_curvature));
      EXPECT_TRUE(same_bytes(a.patch_completeness, b.patch_completeness));
      EXPECT_EQ(a.scale, b.scale);
      EXPECT_EQ(a.step, b.step);
      EXPECT_EQ(a.mean_edge_length, b.mean_edge_length);
    }
  }
}

// Parts far smaller than a patch have no curvature, but they must not spoil anything either.
TEST(EvolvingSurfaceTest, TinyPartsStayFiniteAndInPlace) {
  const TriangleMesh triangle = {{{0, 3, 0}, {0.001, 3, 0}, {0, 3.001, 0}}, {{0, 1, 2}}};
  const TriangleMesh needle = {{{0, -3, 0}, {0.5, -3, 0}, {1, -3, 0}}, {{0, 1, 2}}};
  const TriangleMesh mesh =
      joined(joined(joined(rough_torus(), triangle), tetrahedron(1e-4, {3, 0, 0})), needle);
  for (const bool curved : {true, false}) {
    const EvolvedMesh evolved = evolve_mesh(mesh, 20, {.curved = curved, .remesh = false});
    ASSERT_EQ(evolved.surface.part_count, 4);
    for (std::size_t k = 0; k < evolved.levels.size(); ++k) {
      ASSERT_TRUE(all_finite(evolved.levels[k])) << "level " << k;
      if (k > 0) {
        EXPECT_GT(evolved.levels[k].scale, evolved.levels[k - 1].scale);
      }
      for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        if (evolved.surface.part[v] == 0) continue;
        EXPECT_LT((evolved.point(k, v) - mesh.points[v]).norm(), 1) << "level " << k;
        EXPECT_EQ(evolved.levels[k].patch_completeness[v], 0);
      }
    }
  }
}

// Long after they have collapsed beyond any restoration: scales must go on growing.
TEST(EvolvingSurfaceTest, ATetrahedronAloneAndATriangleAloneStayFinite) {
  const TriangleMesh triangle = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  for (const TriangleMesh& mesh : {triangle, tetrahedron(1, {0, 0, 0})}) {
    const EvolvedMesh evolved = evolve_mesh(mesh, 120);
    for (std::size_t k = 0; k < evolved.levels.size(); ++k) {
      EXPECT_TRUE(all_finite(evolved.levels[k])) << "level " << k;
      if (k > 0) {
        EXPECT_GT(evolved.levels[k].scale, evolved.levels[k - 1].scale);
      }
    }
  }
}

TEST(EvolvingSurfaceTest, AWireVanishesAndLeavesAMark) {
  engine::Workers workers(2);
  engine::Observer observer;
  const kernels::Surface built = kernels::build_surface(shapes::torus(1, 1e-4, 40, 4)).surface;
  EvolvingSurface evolving(kernels::reordered(built, kernels::locality_order(built)), {},
                           {workers, observer, {}});
  EXPECT_FALSE(evolving.vanished());
  EXPECT_EQ(evolving.advance(true).points.size(), 160);
  for (int k = 1; k < 5; ++k) {
    EXPECT_TRUE(evolving.vanished());
    const LevelFields level = evolving.advance(k < 4);
    ASSERT_EQ(level.points.size(), 4) << "level " << k;
    EXPECT_GE((level.points[1] - level.points[0]).norm(), level.shortest_side);
    EXPECT_EQ(*std::ranges::max_element(level.patch_completeness), 0);
  }
}

TEST(EvolvingSurfaceTest, TellsTheObserverOfEveryVertexOfEveryLevel) {
  struct Counter : engine::Observer {
    std::atomic<std::int64_t> work = 0;
    void worked(std::int64_t amount) override { work += amount; }
  } counter;
  engine::Workers workers(2);
  const kernels::Surface built = kernels::build_surface(rough_torus()).surface;
  EvolvingSurface evolving(kernels::reordered(built, kernels::locality_order(built)), {},
                           {workers, counter, {}});
  evolving.advance(true);
  evolving.advance(false);
  EXPECT_EQ(counter.work, 2 * 80 * 36);
}

TEST(EvolvingSurfaceTest, TellsTheObserverHowLongItRemeshed) {
  struct Record : engine::Observer {
    std::vector<std::string> stretches;
    void timed(std::string_view stretch, double seconds, double cpu_seconds) override {
      EXPECT_GE(seconds, 0);
      EXPECT_GE(cpu_seconds, 0);
      stretches.emplace_back(stretch);
    }
  };
  for (const bool remesh : {true, false}) {
    Record record;
    engine::Workers workers(2);
    const kernels::Surface built = kernels::build_surface(rough_torus()).surface;
    EvolvingSurface evolving(kernels::reordered(built, kernels::locality_order(built)),
                             {.remesh = remesh}, {workers, record, {}});
    evolving.advance(true);
    evolving.advance(false);
    EXPECT_EQ(record.stretches,
              remesh ? std::vector<std::string>{"remeshing"} : std::vector<std::string>{});
  }
}

}  // namespace
}  // namespace semigeo::jobs
