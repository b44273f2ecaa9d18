// The mesh of a level under `Schedule::kOctaves` has edges about as long as the level's step.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include "tests/jobs/stages/evolve_mesh.hpp"
#include "tests/support/manifold.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::jobs {
namespace {

using Eigen::Vector3d;
using kernels::TriangleMesh;

constexpr EvolutionOptions kOctaves = {.schedule = Schedule::kOctaves};
constexpr EvolutionOptions kUncoarsened = {.schedule = Schedule::kOctaves, .coarsen = false};

/// The triangles and the source vertices of a level, which may be those of a level before.
struct LevelRows {
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::int32_t> source;
};

std::vector<LevelRows> rows_of(const EvolvedMesh& mesh) {
  LevelRows now{mesh.surface.triangles, {}};
  for (std::int32_t v = 0; v < mesh.surface.vertex_count(); ++v) now.source.push_back(v);
  std::vector<LevelRows> levels;
  for (const LevelFields& level : mesh.levels) {
    if (level.connectivity)
      now = {level.connectivity->triangles, level.connectivity->source_vertex};
    levels.push_back(now);
  }
  return levels;
}

/// Root mean square of value * unit - truth over the whole patches of a level.
double rms_error(const std::vector<float>& values, const LevelFields& level, double unit,
                 double truth) {
  double sum = 0;
  int count = 0;
  for (std::size_t v = 0; v < values.size(); ++v) {
    if (level.patch_completeness[v] < 1) continue;
    sum += std::pow(values[v] * unit - truth, 2);
    ++count;
  }
  return std::sqrt(sum / count);
}

/// Relative root mean square difference of a field between a level of the pyramid and that of the
/// mesh that is not coarsened, at the vertices that both have.
double relative_difference(const std::vector<float>& coarse, const LevelRows& coarse_rows,
                           const std::vector<float>& fine, const LevelRows& fine_rows) {
  std::map<std::int32_t, float> at_source;
  for (std::size_t i = 0; i < fine.size(); ++i) at_source[fine_rows.source[i]] = fine[i];
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    if (coarse_rows.source[i] < 0) continue;
    const double truth = at_source.at(coarse_rows.source[i]);
    difference += std::pow(coarse[i] - truth, 2);
    size += truth * truth;
  }
  return std::sqrt(difference / size);
}

TriangleMesh joined(TriangleMesh a, const TriangleMesh& b, const Vector3d& shift) {
  const auto first = static_cast<std::int32_t>(a.points.size());
  for (const Vector3d& p : b.points) a.points.push_back(p + shift);
  for (const auto& [p, q, r] : b.triangles)
    a.triangles.push_back({p + first, q + first, r + first});
  return a;
}

TEST(OctavePyramidTest, EdgesAreAsLongAsTheStep) {
  for (const TriangleMesh& shape : {shapes::icosphere(6), shapes::torus(1, 0.5, 400, 160, 0.5)}) {
    const EvolvedMesh mesh = evolve_mesh(shape, 5, kOctaves);
    for (std::size_t k = 2; k < mesh.levels.size(); ++k) {
      const LevelFields& level = mesh.levels[k];
      EXPECT_NEAR(level.step / level.mean_edge_length, 0.95, 0.07) << k;
      // Two levels cost a quarter of the two before.
      if (k >= 3) {
        EXPECT_NEAR(static_cast<double>(level.points.size()) /
                        static_cast<double>(mesh.levels[k - 2].points.size()),
                    0.25, 0.05);
      }
    }
  }
}

TEST(OctavePyramidTest, TheStepFactorStays) {
  const EvolvedMesh mesh =
      evolve_mesh(shapes::icosphere(5), 3, {.schedule = Schedule::kOctaves, .step_factor = 2});
  for (const LevelFields& level : mesh.levels)
    EXPECT_NEAR(level.step / level.mean_edge_length, 2, 0.15);
}

// The error of a sphere is that of level 0 of a sphere which is as coarse, within a factor.
TEST(OctavePyramidTest, SpheresKeepTheirCurvature) {
  const EvolvedMesh mesh = evolve_mesh(shapes::icosphere(6), 6, kOctaves);
  double first_h = 0, first_k = 0;
  for (std::size_t k = 0; k < mesh.levels.size(); ++k) {
    const LevelFields& level = mesh.levels[k];
    double radius = 0;
    for (const auto& p : level.points)
      radius += p.cast<double>().norm() / static_cast<double>(level.points.size());
    const double share = std::pow(level.step / radius, 2);
    const double h = rms_error(level.mean_curvature, level, radius, -1) / share;
    const double k_error = rms_error(level.gaussian_curvature, level, radius * radius, 1) / share;
    if (k == 0) {
      first_h = h;
      first_k = k_error;
    }
    EXPECT_LT(h, 3 * first_h) << k;
    EXPECT_LT(k_error, 3 * first_k) << k;
    for (const auto& p : level.points)
      ASSERT_NEAR(p.cast<double>().norm(), radius, 2e-2 * share * radius + 1e-6) << k;
  }
}

TEST(OctavePyramidTest, ToriKeepTheirCurvature) {
  const double minor = 0.4;
  for (const double unevenness : {0.0, 0.5}) {
    const TriangleMesh shape = shapes::torus(1, minor, 200, 80, unevenness);
    const EvolvedMesh coarse = evolve_mesh(shape, 5, kOctaves);
    const EvolvedMesh fine = evolve_mesh(shape, 5, kUncoarsened);
    const std::vector<LevelRows> coarse_rows = rows_of(coarse);
    const std::vector<LevelRows> fine_rows = rows_of(fine);
    EXPECT_EQ(fine.levels[5].points.size(), fine.levels[0].points.size());
    for (std::size_t k = 2; k < coarse.levels.size(); ++k) {
      const LevelFields& level = coarse.levels[k];
      const double share = std::pow(level.step / minor, 2);
      EXPECT_LT(relative_difference(level.mean_curvature, coarse_rows[k],
                                    fine.levels[k].mean_curvature, fine_rows[k]),
                0.12 * share)
          << k;
      EXPECT_LT(relative_difference(level.gaussian_curvature, coarse_rows[k],
                                    fine.levels[k].gaussian_curvature, fine_rows[k]),
                0.4 * share)
          << k;
    }
  }
}

TEST(OctavePyramidTest, EveryLevelIsAManifoldOfTheSameGenusWithValidLineage) {
  const TriangleMesh shape =
      joined(shapes::torus(1, 0.4, 160, 64, 0.3), shapes::cylinder(1, 3, 120, 60), {4, 0, 0});
  const EvolvedMesh mesh = evolve_mesh(shape, 5, kOctaves);
  const std::vector<LevelRows> rows = rows_of(mesh);
  for (std::size_t k = 0; k < mesh.levels.size(); ++k) {
    const LevelFields& level = mesh.levels[k];
    EXPECT_EQ(level.parts, 2);
    TriangleMesh now;
    for (const auto& p : level.points) now.points.push_back(p.cast<double>());
    now.triangles = rows[k].triangles;
    EXPECT_EQ(tests::why_not_manifold(now), "") << k;
    std::set<std::pair<std::int32_t, std::int32_t>> edges;
    for (const auto& t : now.triangles)
      for (int i = 0; i < 3; ++i) edges.insert(std::minmax(t[i], t[(i + 1) % 3]));
    EXPECT_EQ(std::ssize(now.points) - std::ssize(edges) + std::ssize(now.triangles), 0);

    std::int32_t last = -1;
    for (std::size_t i = 0; i < level.points.size(); ++i) {
      const std::int32_t source = rows[k].source[i];
      if (source < 0) continue;
      EXPECT_GT(source, last);  // descendants of level 0 in its order, each once
      last = source;
      EXPECT_LT((mesh.point(k, i) - shape.points[source]).norm(), 2 * level.scale);
    }
    EXPECT_GT(last, 0);
  }
}

TEST(OctavePyramidTest, EveryNumberOfThreadsGivesTheSame) {
  const TriangleMesh shape =
      joined(shapes::torus(1, 0.4, 160, 64, 0.3), shapes::plane(2, 60), {0, 0, 3});
  const EvolvedMesh one = evolve_mesh(shape, 5, kOctaves, 1);
  const EvolvedMesh four = evolve_mesh(shape, 5, kOctaves, 4);
  const std::vector<LevelRows> rows = rows_of(one);
  const std::vector<LevelRows> same_rows = rows_of(four);
  const auto same_bytes = [](const auto& a, const auto& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
  };
  for (std::size_t k = 0; k < one.levels.size(); ++k) {
    EXPECT_EQ(rows[k].triangles, same_rows[k].triangles);
    EXPECT_EQ(rows[k].source, same_rows[k].source);
    EXPECT_TRUE(same_bytes(one.levels[k].points, four.levels[k].points));
    EXPECT_TRUE(same_bytes(one.levels[k].mean_curvature, four.levels[k].mean_curvature));
    EXPECT_TRUE(same_bytes(one.levels[k].gaussian_curvature, four.levels[k].gaussian_curvature));
  }
}

// A part that few patches cover already is left as it is.
TEST(OctavePyramidTest, SmallPartsAreNotCoarsened) {
  const double edge = 2 * std::sqrt(std::numbers::pi / 5 / 1024 / std::sqrt(3));
  TriangleMesh small = shapes::icosphere(2);  // 320 faces, edges as long as those of the large one
  for (Vector3d& p : small.points) p *= edge / 0.3;
  const EvolvedMesh mesh = evolve_mesh(joined(shapes::icosphere(5), small, {3, 0, 0}), 2, kOctaves);
  const LevelFields& level = mesh.levels[2];
  ASSERT_TRUE(level.connectivity.has_value());
  EXPECT_EQ(std::ranges::count(level.connectivity->part, 1), 162);
  EXPECT_LT(std::ranges::count(level.connectivity->part, 0), 6000);

  // The larger one stops when patches cross a good share of it.
  const EvolvedMesh alone = evolve_mesh(shapes::icosphere(5), 6, kOctaves);
  EXPECT_GT(alone.levels[6].points.size(), 1500);
  EXPECT_LT(alone.levels[6].points.size(), 2500);
}

// Refining makes up for what odd triangles cost, not for what was coarsened.
TEST(OctavePyramidTest, RefiningPutsNothingBack) {
  TriangleMesh rough = shapes::icosphere(5);
  shapes::add_noise(rough, 0.01, 3);
  const EvolvedMesh mesh = evolve_mesh(rough, 3, kOctaves);
  for (std::size_t k = 2; k < mesh.levels.size(); ++k) {
    const LevelFields& level = mesh.levels[k];
    EXPECT_GT(level.remeshed.collapsed, 0);
    EXPECT_LT(level.remeshed.split, std::ssize(level.points) / 100);
    EXPECT_LT(std::ssize(level.points), 0.6 * std::ssize(mesh.levels[k - 1].points));
  }
}

TEST(OctavePyramidTest, OthersKeepTheirMesh) {
  for (const EvolutionOptions& options :
       {EvolutionOptions{}, EvolutionOptions{.schedule = Schedule::kOctaves, .remesh = false},
        kUncoarsened})
    for (const LevelFields& level : evolve_mesh(shapes::icosphere(4), 4, options).levels)
      EXPECT_EQ(level.points.size(), 2562);
}

// Faces are as long as sigma there, and the tips are between vertices.
TEST(OctavePyramidTest, TheTipsOfAnEllipsoidAreFoundBetweenVertices) {
  TriangleMesh ellipsoid = shapes::icosphere(6);
  for (Vector3d& p : ellipsoid.points) p = p.cwiseProduct(Vector3d(0.7, 1, 0.5));
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()));
  for (Vector3d& p : ellipsoid.points) p = turn * p;
  const Vector3d tip = turn * Vector3d::UnitY();
  const EvolvedMesh mesh = evolve_mesh(ellipsoid, 5, kOctaves);
  for (std::size_t k = 2; k < mesh.levels.size(); ++k)
    for (const int kind : {0, 1}) {
      std::vector<kernels::Feature> tips = mesh.features[k].of_kind[kind];
      std::erase_if(tips, [](const kernels::Feature& feature) {
        return feature.prominence < 0.05 * std::abs(feature.value);
      });
      ASSERT_EQ(tips.size(), 2) << k;
      for (const kernels::Feature& feature : tips) {
        const Vector3d at = feature.initial_position.cast<double>();
        const double off = std::min((at - tip).norm(), (at + tip).norm());
        EXPECT_LT(off, 0.3 * mesh.levels[k].step) << k;
      }
    }
}

}  // namespace
}  // namespace semigeo::jobs
