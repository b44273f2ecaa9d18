/// The theorems of thesis 4.2.1: what evolution keeps, whatever the surface.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kernels/patch/gaussian.hpp"
#include "tests/jobs/stages/level_shape.hpp"
#include "tests/support/analytic_surfaces.hpp"
#include "tests/support/quantile.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/solids.hpp"
#include "tests/support/triangle_intersections.hpp"

namespace semigeo::jobs {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using kernels::TriangleMesh;
using shapes::rough_torus;
using tests::median;

/// Theorem 1: evolving and then moving, or moving and then evolving.
void expect_similar(const TriangleMesh& mesh, double scale, const Eigen::Quaterniond& turn,
                    const Vector3d& shift) {
  TriangleMesh changed = mesh;
  for (auto& p : changed.points) p = scale * (turn * p) + shift;
  const EvolvedMesh plain = evolve_mesh(mesh, 4, {.remesh = false});
  const EvolvedMesh after = evolve_mesh(changed, 4, {.remesh = false});
  const double edge = plain.levels[0].mean_edge_length;
  for (std::size_t k = 0; k < plain.levels.size(); ++k) {
    const LevelFields& a = plain.levels[k];
    const LevelFields& b = after.levels[k];
    EXPECT_NEAR(b.scale / a.scale, scale, 1e-5 * scale);
    EXPECT_NEAR(b.step / a.step, scale, 1e-5 * scale);
    double largest = 0;
    std::vector<double> point_errors, mean_errors, gaussian_errors;
    for (std::size_t v = 0; v < a.points.size(); ++v) {
      const Vector3d expected = scale * (turn * plain.point(k, v)) + shift;
      const double error = (after.point(k, v) - expected).norm() / (scale * edge);
      largest = std::max(largest, error);
      point_errors.push_back(error);
      mean_errors.push_back(std::abs(b.mean_curvature[v] * scale - a.mean_curvature[v]));
      gaussian_errors.push_back(
          std::abs(b.gaussian_curvature[v] * scale * scale - a.gaussian_curvature[v]));
    }
    // A sample that falls on the other side of a vertex takes another way round it: a few vertices
    // may differ, by little.
    EXPECT_LT(median(std::move(point_errors)), 1e-5) << "level " << k;
    EXPECT_LT(largest, 5e-3) << "level " << k;
    EXPECT_LT(median(std::move(mean_errors)), 1e-5) << "level " << k;  // |H| is 1 ... 4
    EXPECT_LT(median(std::move(gaussian_errors)), 3e-5) << "level " << k;
  }
}

TEST(EvolutionTheoremsTest, SimilarityFirstOrEvolutionFirst_Theorem1) {
  const auto none = Eigen::Quaterniond::Identity();
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(2.1, Vector3d(-1, 2, 0.5).normalized()));
  const TriangleMesh mesh = rough_torus();
  expect_similar(mesh, 0.001, none, Vector3d::Zero());
  expect_similar(mesh, 1000, none, Vector3d::Zero());
  expect_similar(mesh, 1, turn, Vector3d::Zero());
  expect_similar(mesh, 1, none, {3.25, -1.5, 0.125});
  expect_similar(mesh, 1000, turn, {4e6, -2e6, 1e5});  // metres to map millimetres
}

// Lengths are kept in a unit that is a power of two, so such a scaling does not touch a digit.
TEST(EvolutionTheoremsTest, ScalingByAPowerOfTwoIsExact) {
  const EvolvedMesh plain = evolve_mesh(rough_torus(), 3);
  for (const double scale : {0x1p-30, 0x1p-1, 0x1p5, 0x1p30}) {
    TriangleMesh mesh = rough_torus();
    for (auto& p : mesh.points) p *= scale;
    const EvolvedMesh scaled = evolve_mesh(mesh, 3);
    for (std::size_t k = 0; k < plain.levels.size(); ++k)
      for (std::size_t v = 0; v < plain.levels[k].points.size(); ++v) {
        ASSERT_EQ(scaled.point(k, v), scale * plain.point(k, v)) << "scale " << scale;
        ASSERT_EQ(scaled.levels[k].mean_curvature[v] * scale, plain.levels[k].mean_curvature[v]);
      }
  }
}

/// The same through tears: lineage and connectivity too.
TEST(EvolutionTheoremsTest, ScalingByAPowerOfTwoIsExactThroughRemeshing) {
  const std::vector<LevelShape> plain = level_shapes(evolve_mesh(shapes::dumbbell(), 9));
  EXPECT_EQ(plain[9].parts, 2);
  for (const double scale : {0x1p-20, 0x1p7}) {
    TriangleMesh mesh = shapes::dumbbell();
    for (auto& p : mesh.points) p *= scale;
    const std::vector<LevelShape> scaled = level_shapes(evolve_mesh(mesh, 9));
    ASSERT_EQ(scaled.size(), plain.size());
    for (std::size_t k = 0; k < plain.size(); ++k) {
      ASSERT_EQ(scaled[k].mesh.triangles, plain[k].mesh.triangles) << "level " << k;
      ASSERT_EQ(scaled[k].source, plain[k].source) << "level " << k;
      for (std::size_t v = 0; v < plain[k].mesh.points.size(); ++v)
        ASSERT_EQ(scaled[k].mesh.points[v], scale * plain[k].mesh.points[v]) << "level " << k;
    }
  }
}

// What is about to be torn decides by its last digit where it tears; what comes of that is small.
TEST(EvolutionTheoremsTest, SimilarityFirstOrEvolutionFirstThroughRemeshing_Theorem1) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(2.1, Vector3d(-1, 2, 0.5).normalized()));
  const double scale = 1000;
  for (const TriangleMesh& mesh : {shapes::dumbbell(), shapes::phone()}) {
    TriangleMesh changed = mesh;
    for (auto& p : changed.points) p = scale * (turn * p) + Vector3d(4e4, -2e4, 1e3);
    const std::vector<LevelShape> plain = level_shapes(evolve_mesh(mesh, 14));
    const std::vector<LevelShape> after = level_shapes(evolve_mesh(changed, 14));
    const auto near = [](double is, double was, double tolerance) {
      return std::abs(is / was - 1) < tolerance;
    };
    bool torn = false;
    for (std::size_t k = 0; k < plain.size(); ++k) {
      const LevelShape &a = plain[k], &b = after[k];
      torn = torn || a.parts > 1;
      // Crumbs of a neck may be one more or less.
      if (!torn || k == 14) EXPECT_EQ(b.parts, a.parts) << "level " << k;
      if (!torn) EXPECT_EQ(b.mesh.points.size(), a.mesh.points.size()) << "level " << k;
      const double few = torn ? 0.03 : 1e-9;
      EXPECT_TRUE(near(b.mesh.points.size(), a.mesh.points.size(), few)) << "level " << k;
      EXPECT_TRUE(near(b.mesh.triangles.size(), a.mesh.triangles.size(), few)) << "level " << k;
      EXPECT_TRUE(near(volume(b), std::pow(scale, 3) * volume(a), torn ? 2e-3 : 1e-6))
          << "level " << k << ": " << volume(b) / std::pow(scale, 3) / volume(a) - 1;
      EXPECT_TRUE(near(area(b), scale * scale * area(a), torn ? 5e-3 : 1e-6)) << "level " << k;
    }
    EXPECT_TRUE(torn);
  }
}

/// The farthest that points reach into a direction.
double reach(const std::vector<Vector3d>& points, const Vector3d& direction) {
  double farthest = -1e300;
  for (const auto& p : points) farthest = std::max(farthest, p.dot(direction));
  return farthest;
}

// Without the rescaling a closed surface never leaves the convex hull of the level before. The
// curved surface through the vertices bulges out of it, but smoothing takes back more, except at
// creases, by a hundredth of an edge.
TEST(EvolutionTheoremsTest, StaysInItsConvexHull_Theorem2) {
  for (const bool curved : {false, true})
    for (const TriangleMesh& mesh : {rough_torus(), shapes::dumbbell(), shapes::cube(2, 8)}) {
      const EvolvedMesh evolved =
          evolve_mesh(mesh, 15, {.curved = curved, .rescale = Rescale::kNone});
      const std::vector<LevelShape> levels = level_shapes(evolved);
      for (std::size_t k = 1; k < levels.size(); ++k) {
        // What is left within a step is no surface to its patches; in the end it is replaced.
        const auto& before = levels[k - 1].mesh.points;
        const double height = reach(before, {0, 0, 1}) + reach(before, {0, 0, -1});
        if (height < 2 * evolved.levels[0].step) break;
        const double most = curved ? 0.01 * evolved.levels[0].mean_edge_length : 0;
        for (const Vector3d& direction : shapes::icosphere(2).points)
          EXPECT_LE(reach(levels[k].mesh.points, direction),
                    reach(levels[k - 1].mesh.points, direction) + most)
              << "level " << k;
      }
    }
}

/// Largest and median |displacement / (variance / 2) - 2 H n| over |2 H n|'s root mean square.
struct FlowError {
  double edge, median, most;
};
FlowError flow_error(const shapes::AnalyticMesh& mesh, const EvolutionOptions& options) {
  const EvolvedMesh evolved = evolve_mesh(mesh.mesh, 1, options);
  const double step = evolved.levels[0].step;
  const double variance = kernels::gaussian_filters().variance * step * step;
  std::vector<double> errors;
  double size = 0;
  for (std::size_t v = 0; v < mesh.truth.size(); ++v) {
    const Vector3d flow = 2 * mesh.truth[v].mean * mesh.truth[v].normal;
    const Vector3d moved = evolved.point(1, v) - mesh.mesh.points[v];
    errors.push_back((moved / (variance / 2) - flow).norm());
    size += flow.squaredNorm() / static_cast<double>(mesh.truth.size());
  }
  return {evolved.levels[0].mean_edge_length, median(errors) / std::sqrt(size),
          tests::quantile(errors, 0.99) / std::sqrt(size)};
}

// On curved faces the step may shrink with the edges. Second order but for irregular vertices, of
// which there are ever fewer: the median falls faster than the largest error.
TEST(EvolutionTheoremsTest, DisplacementTendsToMeanCurvatureFlow) {
  for (const auto& surface : shapes::analytic_surfaces()) {
    if (surface.open()) continue;
    for (const auto tessellation : {shapes::Tessellation::kEven, shapes::Tessellation::kUneven}) {
      SCOPED_TRACE(surface.name + ", " + name_of(tessellation));
      const EvolutionOptions options{.rescale = Rescale::kNone, .remesh = false};
      const FlowError coarse = flow_error(tessellate(surface, tessellation, 642), options);
      const FlowError fine = flow_error(tessellate(surface, tessellation, 10242), options);
      const double finer = std::log(coarse.edge / fine.edge);
      EXPECT_GT(std::log(coarse.median / fine.median) / finer, 1.35);
      EXPECT_GT(std::log(coarse.most / fine.most) / finer, 1);
      EXPECT_LT(fine.median, 5e-3);
      EXPECT_LT(fine.most, 3e-2);
    }
  }
}

// Flat faces lie inside a convex surface by as much as the flow takes in a step of one edge; the
// step has to be long against the edges, and short against the surface.
TEST(EvolutionTheoremsTest, OnFlatFacesDisplacementTendsToTheFlowOverLongerSteps) {
  const auto& sphere = shapes::analytic_surfaces()[0];
  ASSERT_EQ(sphere.name, "sphere");
  const auto mesh = tessellate(sphere, shapes::Tessellation::kEven, 40962);
  double errors[3];
  for (int i = 0; i < 3; ++i)
    errors[i] = flow_error(mesh, {.curved = false,
                                  .rescale = Rescale::kNone,
                                  .remesh = false,
                                  .step_factor = std::exp2(i)})
                    .median;
  EXPECT_GT(errors[0], 0.05);
  EXPECT_LT(errors[1], errors[0] / 3);
  EXPECT_LT(errors[2], errors[1] / 3);
}

// r^2 = r0^2 - 2 variance per level.
TEST(EvolutionTheoremsTest, ASphereShrinksByMeanCurvatureFlow) {
  const EvolvedMesh evolved = evolve_mesh(shapes::icosphere(4), 60, {.rescale = Rescale::kNone});
  const double step = evolved.levels[0].step;
  const double variance = kernels::gaussian_filters().variance * step * step;
  for (std::size_t k = 0; k < evolved.levels.size(); ++k) {
    double nearest = 2, farthest = 0;
    for (const Vector3f& p : evolved.levels[k].points) {
      nearest = std::min<double>(nearest, p.norm());
      farthest = std::max<double>(farthest, p.norm());
    }
    EXPECT_LT(farthest - nearest, 5e-5) << "level " << k;
    const double expected = 1 - 2 * variance * static_cast<double>(k);
    EXPECT_NEAR(farthest * farthest, expected, 0.01 * (1 - expected)) << "level " << k;
  }
  EXPECT_LT(evolved.levels.back().points[0].norm(), 0.6);
}

TEST(EvolutionTheoremsTest, ASimpleSurfaceStaysSimple) {
  const TriangleMesh bumpy = shapes::bumpy_sphere(4, 0.15);
  for (const LevelShape& level : level_shapes(evolve_mesh(bumpy, 30)))
    EXPECT_EQ(tests::count_intersections(level.mesh), 0);
}

// Also while a neck gets thin, and where it has just been torn. What is left of it is a spike whose
// tip, thinner than the step, may cross itself while it shrinks.
TEST(EvolutionTheoremsTest, ASimpleSurfaceStaysSimpleUntilItTearsAndInTheEnd) {
  for (const TriangleMesh& mesh : {shapes::dumbbell(), shapes::phone()}) {
    const std::vector<LevelShape> levels = level_shapes(evolve_mesh(mesh, 30));
    bool torn = false;
    for (std::size_t k = 0; k < levels.size(); ++k) {
      const std::int64_t found = tests::count_intersections(levels[k].mesh);
      const double most = torn && k < 30 ? 0.02 * static_cast<double>(mesh.triangles.size()) : 0;
      EXPECT_LE(static_cast<double>(found), most) << "level " << k;
      torn = torn || levels[k].parts > 1;
    }
    EXPECT_TRUE(torn);
  }
}

}  // namespace
}  // namespace semigeo::jobs
