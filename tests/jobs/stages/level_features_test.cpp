#include "jobs/stages/level_features.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>

#include "kernels/surface/nearest_surface.hpp"
#include "tests/jobs/stages/evolve_mesh.hpp"
#include "tests/support/analytic_surfaces.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/solids.hpp"

namespace semigeo::jobs {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using kernels::Feature;
using kernels::FeatureKind;
using kernels::LevelFeatures;
using kernels::SampledContours;
using kernels::TriangleMesh;
using std::numbers::pi;

constexpr int kGaussian = static_cast<int>(FeatureKind::kGaussian);
constexpr int kMean = static_cast<int>(FeatureKind::kMean);

std::vector<Vector3f> points_of(const SampledContours& contours, std::int64_t contour) {
  return {contours.points.begin() + contours.offsets[contour],
          contours.points.begin() + contours.offsets[contour + 1]};
}

double length_of(const SampledContours& contours, std::int64_t contour) {
  const std::vector<Vector3f> points = points_of(contours, contour);
  double length = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (i + 1 < points.size() || contours.closed[contour] != 0)
      length += (points[(i + 1) % points.size()] - points[i]).norm();
  return length;
}

/// A peanut about the z axis: r = 1 + cos(2 theta) / 2 in polar coordinates.
double radius_at(double theta) {
  return 1 + std::cos(2 * theta) / 2;
}

/// Curvatures of meridian and parallel there, positive where convex.
std::pair<double, double> curvatures_at(double theta) {
  const double r = radius_at(theta);
  const double r1 = -std::sin(2 * theta);
  const double r2 = -2 * std::cos(2 * theta);
  const double speed2 = r * r + r1 * r1;
  const double meridian = (r * r + 2 * r1 * r1 - r * r2) / std::pow(speed2, 1.5);
  const double fall = r * std::sin(theta) - r1 * std::cos(theta);  // -dz / d theta
  return {meridian, fall / (r * std::sin(theta) * std::sqrt(speed2))};
}

TriangleMesh peanut(int levels) {
  TriangleMesh mesh = shapes::icosphere(levels);
  for (Vector3d& p : mesh.points) p *= radius_at(std::acos(std::clamp(p.z(), -1.0, 1.0)));
  return mesh;
}

/// Where `value` changes its sign between the pole and the waist.
double root(const std::function<double(double)>& value) {
  double low = 0.1, high = pi / 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    ((value(middle) > 0) == (value(low) > 0) ? low : high) = middle;
  }
  return low;
}

TEST(LevelFeaturesTest, GaussianContoursOfATorusAreTwoCircles) {
  // K = 0 on top and at the bottom, where the tube's normal is parallel to the axis.
  const double major = 1, minor = 0.4;
  const EvolvedMesh torus = evolve_mesh(shapes::torus(major, minor, 200, 80, 0.3), 3);
  for (std::size_t level = 0; level < torus.levels.size(); ++level) {
    const SampledContours& contours = torus.features[level].contours[0];
    ASSERT_EQ(contours.count(), 2) << level;
    for (int c = 0; c < 2; ++c) {
      EXPECT_EQ(contours.closed[c], 1);
      EXPECT_NEAR(length_of(contours, c), 2 * pi * major, 0.01 * 2 * pi * major) << level;
      if (level > 0) continue;
      for (const Vector3f& p : points_of(contours, c)) {
        EXPECT_NEAR(std::abs(p.z()), minor, 1e-3);
        EXPECT_NEAR(std::hypot(p.x(), p.y()), major, 5e-3);
      }
    }
    EXPECT_NEAR(contours.length, 4 * pi * major, 0.01 * 4 * pi * major);
    EXPECT_EQ(torus.features[level].contours[1].count(), 0);  // H < 0 all over
    // Circles are plane curves.
    for (const float torsion : contours.torsion) EXPECT_LT(std::abs(torsion), 0.05 / major);
  }
}

TEST(LevelFeaturesTest, ContoursOfAPeanutAreWhereCalculusPutsThem) {
  const double mean_root = root([](double theta) {
    const auto [meridian, parallel] = curvatures_at(theta);
    return meridian + parallel;
  });
  const double gaussian_root = root([](double theta) { return curvatures_at(theta).first; });
  double last_error = 1;
  for (const int levels : {4, 5, 6}) {
    const EvolvedMesh mesh = evolve_mesh(peanut(levels), 0);
    double error = 0;
    for (const int kind : {kGaussian, kMean}) {
      const double theta = kind == kGaussian ? gaussian_root : mean_root;
      const double height = radius_at(theta) * std::cos(theta);
      const double circle = 2 * pi * radius_at(theta) * std::sin(theta);
      const SampledContours& contours = mesh.features[0].contours[kind];
      ASSERT_EQ(contours.count(), 2);
      for (int c = 0; c < 2; ++c) {
        EXPECT_EQ(contours.closed[c], 1);
        EXPECT_NEAR(length_of(contours, c), circle, (levels == 6 ? 0.01 : 0.02) * circle);
        for (const Vector3f& p : points_of(contours, c))
          error = std::max(error, std::abs(std::abs(p.z()) - height));
      }
    }
    EXPECT_LT(error, 0.5 * last_error);  // at least first order in the edges, here more
    last_error = error;
  }
  EXPECT_LT(last_error, 2e-3);
}

TEST(LevelFeaturesTest, AnEllipsoidIsPointedAtTwoEnds) {
  // K at the tips of the axes a > b > c is (a / (b c))^2 and so on; the pass between both ends is
  // at b.
  const double a = 1, b = 0.7, c = 0.5;
  TriangleMesh ellipsoid = shapes::icosphere(5);
  for (Vector3d& p : ellipsoid.points) p = p.cwiseProduct(Vector3d(b, a, c));
  const EvolvedMesh mesh = evolve_mesh(ellipsoid, 0);
  const LevelFields& level = mesh.levels[0];
  for (const int kind : {kGaussian, kMean}) {
    std::vector<Feature> tips = mesh.features[0].of_kind[kind];
    std::erase_if(tips,
                  [](const Feature& tip) { return tip.prominence < 0.01 * std::abs(tip.value); });
    ASSERT_EQ(tips.size(), 2);
    std::ranges::sort(tips, std::ranges::greater(), &Feature::prominence);
    const double k = std::pow(a / (b * c), 2), pass_k = std::pow(b / (a * c), 2);
    const double h = (a / (b * b) + a / (c * c)) / 2, pass_h = (b / (a * a) + b / (c * c)) / 2;
    const double top = kind == kGaussian ? k : -h;
    const double pass = kind == kGaussian ? pass_k : pass_h;
    for (const Feature& tip : tips) {
      EXPECT_NEAR(std::abs(tip.position.y()), a, 1e-3);
      EXPECT_LT((tip.position - level.points[tip.vertex]).norm(), 0.5 * level.mean_edge_length);
      EXPECT_EQ(tip.initial_position, tip.position);
      EXPECT_NEAR(tip.normal.y() * (tip.position.y() > 0 ? 1 : -1), 1, 1e-3);
      EXPECT_NEAR(tip.value, top, 0.01 * std::abs(top));
      EXPECT_NEAR(tip.scale_free_gaussian, std::sqrt(k) * level.scale, 0.01);
      EXPECT_NEAR(tip.scale_free_mean, -h * level.scale, 0.01);
    }
    EXPECT_NEAR(tips[0].prominence, std::abs(top), 0.01 * std::abs(top));
    EXPECT_NEAR(tips[1].prominence, std::abs(top) - pass, 0.02 * std::abs(top));
  }
  EXPECT_EQ(mesh.features[0].contours[0].count(), 0);
  EXPECT_EQ(mesh.features[0].contours[1].count(), 0);
}

/// But for the one vertex that is higher than all others by the error of K and H.
TEST(LevelFeaturesTest, ASphereHasNone) {
  const EvolvedMesh sphere = evolve_mesh(shapes::icosphere(5), 2);
  for (const LevelFeatures& level : sphere.features)
    for (const auto& features : level.of_kind) EXPECT_LE(features.size(), 1);
}

TEST(LevelFeaturesTest, WhatIsFlatHasNone) {
  TriangleMesh plane = shapes::plane(1, 40);
  for (Vector3d& p : plane.points) p += Vector3d(30, 20, 10);
  for (const FeatureOptions& options : {FeatureOptions{}, FeatureOptions{.radius = 0}}) {
    const EvolvedMesh mesh = evolve_mesh(plane, 2, {}, 2, options);
    for (const LevelFeatures& level : mesh.features) {
      for (const auto& features : level.of_kind) EXPECT_TRUE(features.empty());
      for (const auto& contours : level.contours) EXPECT_EQ(contours.count(), 0);
    }
  }
}

TEST(LevelFeaturesTest, IncompletePatchesGiveNone) {
  const EvolvedMesh rough = evolve_mesh(shapes::saddle(2, 30), 1, {}, 2, {.min_completeness = 0.9});
  const EvolvedMesh all = evolve_mesh(shapes::saddle(2, 30), 1, {}, 2, {.min_completeness = 0.2});
  for (const int kind : {kGaussian, kMean}) {
    for (const Feature& feature : rough.features[1].of_kind[kind])
      EXPECT_GE(rough.levels[1].patch_completeness[feature.vertex], 0.9);
    EXPECT_GT(all.features[1].of_kind[kind].size(), rough.features[1].of_kind[kind].size());
  }
}

TEST(LevelFeaturesTest, AWiderRadiusKeepsSomeOfThem) {
  const TriangleMesh mesh = shapes::rough_torus();
  const EvolvedMesh ring = evolve_mesh(mesh, 2, {}, 2, {.radius = 0});
  const EvolvedMesh wide = evolve_mesh(mesh, 2, {}, 2, {.radius = 1.5});
  for (std::size_t level = 0; level < ring.levels.size(); ++level)
    for (const int kind : {kGaussian, kMean}) {
      const auto& many = ring.features[level].of_kind[kind];
      const auto& few = wide.features[level].of_kind[kind];
      EXPECT_LT(few.size(), many.size());
      EXPECT_GT(few.size(), 0);
      for (const Feature& feature : few)
        EXPECT_TRUE(std::ranges::count(many, feature.vertex, &Feature::vertex) == 1);
      // No two of the same sign within the radius.
      const double radius = 1.5 * wide.levels[level].scale;
      for (const Feature& f : few)
        for (const Feature& g : few)
          if (&f != &g && (f.value > 0) == (g.value > 0))
            EXPECT_GT((f.position - g.position).norm(), 0.5 * radius);
    }
}

/// On level 0 a torsion feature lies where its sample does; curvatures are those of the contour.
TEST(LevelFeaturesTest, TorsionFeaturesLieOnTheirContours) {
  const EvolvedMesh mesh = evolve_mesh(shapes::bumpy_sphere(5, 0.2), 2);
  for (std::size_t level = 0; level < mesh.levels.size(); ++level)
    for (int kind = 0; kind < 2; ++kind) {
      const SampledContours& contours = mesh.features[level].contours[kind];
      const auto& features = mesh.features[level].of_kind[2 + kind];
      ASSERT_GT(features.size(), 5);
      ASSERT_EQ(features.size(), contours.maxima.size());
      for (std::size_t i = 0; i < features.size(); ++i) {
        const Feature& feature = features[i];
        EXPECT_EQ(feature.position, contours.points[contours.maxima[i]]);
        EXPECT_EQ(feature.value, contours.torsion[contours.maxima[i]]);
        EXPECT_GT(feature.prominence, 0);
        EXPECT_LE(feature.prominence, std::abs(feature.value));
        EXPECT_NEAR(kind == 0 ? feature.scale_free_gaussian : feature.scale_free_mean, 0, 0.02);
        EXPECT_NEAR(feature.normal.norm(), 1, 1e-5);
        const LevelFields& fields = mesh.levels[level];
        EXPECT_LT((fields.points[feature.vertex] - feature.position).norm(),
                  fields.mean_edge_length);
      }
    }
}

TEST(LevelFeaturesTest, PositionsOnLevelZeroOutliveRemeshing) {
  const EvolvedMesh mesh = evolve_mesh(shapes::chair(), 8);
  const kernels::NearestSurface first(mesh.surface);
  const double edge = mesh.levels[0].mean_edge_length;
  bool remeshed = false;
  for (std::size_t level = 1; level < mesh.levels.size(); ++level) {
    const LevelFields& fields = mesh.levels[level];
    remeshed = remeshed || fields.connectivity.has_value();
    for (const Feature& feature : mesh.features[level].of_kind[kMean]) {
      // Between places on level 0 that were neighbours there, or have become neighbours.
      const double distance = first.nearest(feature.initial_position.cast<double>()).distance;
      EXPECT_LT(distance, edge);
      // Nothing has moved farther than the smoothing reaches.
      EXPECT_LT((feature.initial_position - feature.position).norm(), 6 * fields.scale);
    }
  }
  EXPECT_TRUE(remeshed);
}

template <typename Value>
bool same_bytes(const std::vector<Value>& a, const std::vector<Value>& b) {
  return std::ranges::equal(std::as_bytes(std::span(a)), std::as_bytes(std::span(b)));
}

bool same(const Feature& a, const Feature& b) {
  return a.vertex == b.vertex && a.value == b.value && a.prominence == b.prominence &&
         a.position == b.position && a.initial_position == b.initial_position &&
         a.normal == b.normal && a.scale_free_gaussian == b.scale_free_gaussian &&
         a.scale_free_mean == b.scale_free_mean;
}

TEST(LevelFeaturesTest, TheNumberOfThreadsChangesNothing) {
  TriangleMesh mesh = shapes::rough_torus();
  const EvolvedMesh one = evolve_mesh(mesh, 2, {}, 1);
  for (const int threads : {2, 3}) {
    const EvolvedMesh many = evolve_mesh(mesh, 2, {}, threads);
    for (std::size_t level = 0; level < one.levels.size(); ++level) {
      const LevelFeatures& a = one.features[level];
      const LevelFeatures& b = many.features[level];
      for (int kind = 0; kind < kernels::kFeatureKinds; ++kind)
        EXPECT_TRUE(std::ranges::equal(a.of_kind[kind], b.of_kind[kind], same));
      for (int kind = 0; kind < 2; ++kind) {
        EXPECT_TRUE(same_bytes(a.contours[kind].points, b.contours[kind].points));
        EXPECT_TRUE(same_bytes(a.contours[kind].torsion, b.contours[kind].torsion));
        EXPECT_EQ(a.contours[kind].offsets, b.contours[kind].offsets);
        EXPECT_EQ(a.contours[kind].closed, b.contours[kind].closed);
        EXPECT_EQ(a.contours[kind].maxima, b.contours[kind].maxima);
        EXPECT_EQ(a.contours[kind].length, b.contours[kind].length);
      }
    }
  }
}

/// A similarity moves the features along and leaves the scale-free curvatures alone.
TEST(LevelFeaturesTest, SimilaritiesMoveThemAlong) {
  const TriangleMesh mesh = shapes::bumpy_sphere(5, 0.2);
  TriangleMesh moved = mesh;
  for (Vector3d& p : moved.points)
    p = 1e-3 * Vector3d(p.y(), -p.x(), p.z()) + Vector3d(0.001, 0.002, 0.003);
  const EvolvedMesh a = evolve_mesh(mesh, 1);
  const EvolvedMesh b = evolve_mesh(moved, 1);
  for (const int kind : {kGaussian, kMean}) {
    const auto& here = a.features[1].of_kind[kind];
    const auto& there = b.features[1].of_kind[kind];
    ASSERT_GT(here.size(), 10);
    std::int64_t found = 0;
    for (const Feature& feature : here) {
      const auto same = std::ranges::find(there, feature.vertex, &Feature::vertex);
      if (same == there.end()) continue;
      ++found;
      EXPECT_NEAR(same->scale_free_gaussian, feature.scale_free_gaussian, 0.02);
      EXPECT_NEAR(same->scale_free_mean, feature.scale_free_mean, 0.02);
    }
    EXPECT_GE(found, 0.95 * static_cast<double>(here.size()));
  }
}

}  // namespace
}  // namespace semigeo::jobs
