#include "kernels/recognition/overlap.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>

#include "kernels/recognition/surface_samples.hpp"
#include "tests/support/random_similarity.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::kernels {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// An ellipsoid with a bump on it: no similarity maps it to itself.
struct Body {
  std::vector<Vector3f> points;
  std::vector<Vector3f> normals;
  std::vector<std::array<std::int32_t, 3>> triangles;
  double diagonal = std::sqrt(4 * (1 + 0.49 + 0.25));

  Body() {
    const TriangleMesh sphere = shapes::icosphere(4);
    triangles = sphere.triangles;
    for (const Vector3d& u : sphere.points) {
      const double bump = 0.3 * std::exp(-8 * (u - Vector3d(0.6, 0.6, 0.53)).squaredNorm());
      points.push_back(((1 + bump) * u.cwiseProduct(Vector3d(1, 0.7, 0.5))).cast<float>());
    }
    normals.assign(points.size(), Vector3f::Zero());
    for (const auto& [a, b, c] : triangles) {
      const Vector3f area = (points[b] - points[a]).cross(points[c] - points[a]);
      for (const std::int32_t v : {a, b, c}) normals[v] += area;
    }
    for (Vector3f& normal : normals) normal.normalize();
  }

  SurfaceSamples samples(std::int64_t count) const {
    return sample_surface(points, triangles, normals, count);
  }

  Body moved(const Similarity& pose) const {
    Body body = *this;
    for (Vector3f& p : body.points) p = pose.apply(p.cast<double>()).cast<float>();
    for (Vector3f& n : body.normals) n = (pose.rotation * n.cast<double>()).cast<float>();
    return body;
  }

  /// What lies on the positive side of x.
  Body half() const {
    Body body = *this;
    std::erase_if(body.triangles, [&](const auto& t) { return points[t[0]].x() < 0; });
    return body;
  }
};

Similarity shaken(const Similarity& pose, double diagonal, std::mt19937_64& random) {
  Similarity move;
  move.rotation = Eigen::AngleAxisd(0.12, random_direction(random)).toRotationMatrix();
  move.scale = 1.06;
  const Vector3d middle = pose.translation;
  move.translation = middle - move.scale * (move.rotation * middle) +
                     0.03 * diagonal * pose.scale * random_direction(random);
  return move * pose;
}

TEST(Overlap, NearestSampleIsTheNearest) {
  const SurfaceSamples samples = Body().samples(500);
  const SampleTree tree(samples);
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const Vector3f p = random_direction(random).cast<float>();
    std::int64_t best = 0;
    for (std::size_t i = 0; i < samples.points.size(); ++i)
      if ((samples.points[i] - p).norm() < (samples.points[best] - p).norm())
        best = static_cast<std::int64_t>(i);
    EXPECT_EQ(tree.nearest(p, 10), best);
    const float distance = (samples.points[best] - p).norm();
    EXPECT_EQ(tree.nearest(p, 0.99F * distance), -1);
  }
  const SurfaceSamples none;
  EXPECT_EQ(SampleTree(none).nearest({0, 0, 0}, 1), -1);
}

TEST(Overlap, IsWholeInTheRightPoseAndNoneElsewhere) {
  std::mt19937_64 random(2);
  const Body body;
  const Similarity truth = random_similarity(random);
  const SurfaceSamples model = body.samples(1000);
  const SurfaceSamples scene = body.moved(truth).samples(3000);
  const SampleTree tree(scene);
  const Overlap right = overlap(model, body.diagonal, truth, tree, {}, 1000);
  EXPECT_GT(right.match, 0.99);
  EXPECT_LT(right.conflict, 0.01);
  EXPECT_GT(right.closeness, 0.98);
  EXPECT_GT(right.agreement(), 0.95);

  Similarity away = truth;
  away.translation += Vector3d(0, 0, 3 * body.diagonal * truth.scale);
  const Overlap nothing = overlap(model, body.diagonal, away, tree, {}, 1000);
  EXPECT_EQ(nothing.match, 0);
  EXPECT_EQ(nothing.conflict, 0);
  EXPECT_EQ(nothing.agreement(), 0);

  // Inside out: everywhere near, nowhere facing the same way.
  SurfaceSamples inverted = model;
  for (Vector3f& normal : inverted.normals) normal = -normal;
  const Overlap against = overlap(inverted, body.diagonal, truth, tree, {}, 1000);
  EXPECT_EQ(against.match, 0);
  EXPECT_GT(against.conflict, 0.99);
}

TEST(Overlap, StabilityIsOfWhatMatches) {
  const Body body;
  const SurfaceSamples model = body.samples(1000);
  const auto stability = [&](const SurfaceSamples& scene) {
    return overlap(model, body.diagonal, {}, SampleTree(scene), {.stability = true}, 1000)
        .stability;
  };
  const double whole = stability(body.samples(2000));
  EXPECT_GT(whole, 0.01);
  // A small piece is more like a sphere's, which slips along itself.
  Body piece = body;
  std::erase_if(piece.triangles, [&](const auto& t) { return body.points[t[0]].x() < 0.85F; });
  EXPECT_LT(stability(piece.samples(2000)), 0.5 * whole);
  EXPECT_EQ(overlap(model, body.diagonal, {}, SampleTree(model), {}, 1000).stability, 0)
      << "nobody asked";
}

/// A cup: a slender body of revolution with a knob at its side.
SurfaceSamples cup() {
  SurfaceSamples samples;
  for (const Vector3d& u : shapes::icosphere(4).points) {
    const double knob = 0.4 * std::exp(-30 * (u - Vector3d(1, 0, 0)).squaredNorm());
    const Vector3d p = (1 + knob) * u.cwiseProduct(Vector3d(0.6, 0.6, 1.2 + 0.3 * u.z()));
    samples.points.push_back(p.cast<float>());
    samples.normals.push_back(
        u.cwiseQuotient(Vector3d(0.6, 0.6, 1.2 + 0.3 * u.z())).normalized().cast<float>());
  }
  samples.spacing = 0.08F;
  return samples;
}

// With the knob on the wrong side nearly everything fits: one of the turns puts it right.
TEST(Overlap, OneOfTheTurnsPutsACupRight) {
  const SurfaceSamples model = cup();
  const SampleTree tree(model);
  const double diagonal = 3;
  Similarity wrong;
  wrong.rotation = Eigen::AngleAxisd(2.0, Vector3d::UnitZ()).toRotationMatrix();
  const auto turns = symmetric_poses(model, diagonal, wrong, tree, {}, 2000);
  EXPECT_EQ(turns.size(), 23U + 35U);
  double least = std::numbers::pi;
  for (const Similarity& pose : turns) {
    EXPECT_NEAR(pose.scale, 1, 1e-9);
    least = std::min(least, rotation_between(pose.rotation, Eigen::Matrix3d::Identity()));
  }
  EXPECT_LT(least, 5.5 * std::numbers::pi / 180);  // half a step of ten degrees, and the knob
}

TEST(Overlap, WhatCannotSlipIsTurnedAsACubeOnly) {
  const Body body;
  const SurfaceSamples model = body.samples(1000);
  const auto turns = symmetric_poses(model, body.diagonal, {}, SampleTree(model), {}, 1000);
  ASSERT_EQ(turns.size(), 23U);
  // A cube has 6 quarter turns, 8 third turns and 9 half turns. Together they are a group, so their
  // mean takes every point to the one that all turns leave where it is.
  std::map<long, int> of_degrees;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Similarity& pose : turns) {
    const double angle = rotation_between(pose.rotation, Eigen::Matrix3d::Identity());
    ++of_degrees[std::lround(angle * 180 / std::numbers::pi)];
    middle += pose.translation / 24;
  }
  EXPECT_EQ(of_degrees, (std::map<long, int>{{90, 6}, {120, 8}, {180, 9}}));
  for (const Similarity& pose : turns) EXPECT_LT((pose.apply(middle) - middle).norm(), 1e-6);
  EXPECT_TRUE(symmetric_poses({}, 1, {}, SampleTree(model), {}, 100).empty());
}

TEST(Overlap, AHalfMatchesHalfWithoutMuchConflict) {
  const Body body;
  const SurfaceSamples model = body.samples(1000);
  const SurfaceSamples scene = body.half().samples(2000);
  const Overlap half = overlap(model, body.diagonal, {}, SampleTree(scene), {}, 1000);
  const auto there =
      std::ranges::count_if(model.points, [](const Vector3f& p) { return p.x() > 0; });
  EXPECT_NEAR(half.match, static_cast<double>(there) / 1000, 0.06);  // and a spacing more
  EXPECT_LT(half.conflict, 0.06);                                    // a band beside the cut
  // And all of the half is explained.
  const auto marks = samples_on_model(SampleTree(model), body.diagonal, {}, scene, {}, 2000);
  EXPECT_GT(std::ranges::count(marks, 1), 1980);
}

// A half that knows of its rim is not contradicted beyond it; nor, seen from one side only, behind
// itself.
TEST(Overlap, BeyondTheRimAndBehindTheSurfaceNobodyKnows) {
  const Body body;
  const SurfaceSamples model = body.samples(1000);
  const Body half = body.half();
  SurfaceSamples scene = half.samples(2000);
  mark_rim(half.points, half.triangles, scene);
  ASSERT_EQ(scene.rim.size(), 2000U);
  for (std::size_t i = 0; i < scene.rim.size(); ++i) {
    // The cut runs along triangles, up to an edge of 0.07 from x = 0.
    if (scene.points[i].x() > 2 * scene.spacing + 0.07F) EXPECT_EQ(scene.rim[i], 0);
    if (scene.points[i].x() < 2 * scene.spacing - 0.07F) EXPECT_EQ(scene.rim[i], 1);
  }
  EXPECT_LT(overlap(model, body.diagonal, {}, SampleTree(scene), {}, 1000).conflict, 0.005);

  // The model, a little smaller and inside out, lies behind the surface.
  SurfaceSamples inside = model;
  for (Vector3f& normal : inside.normals) normal = -normal;
  const Similarity smaller = {.scale = 0.97};
  const double open = overlap(inside, body.diagonal, smaller, SampleTree(scene), {}, 1000).conflict;
  const SurfaceSamples whole = body.samples(2000);
  const double closed =
      overlap(inside, body.diagonal, smaller, SampleTree(whole), {}, 1000).conflict;
  EXPECT_LT(open, 0.02);
  EXPECT_GT(closed, 0.95);
}

TEST(Overlap, WhatIsUsedIsNeutral) {
  const Body body;
  const SurfaceSamples model = body.samples(1000);
  const SampleTree tree(model);
  std::vector<std::uint8_t> used(1000);
  for (std::size_t i = 0; i < used.size(); ++i) used[i] = model.points[i].x() < 0 ? 1 : 0;
  const Overlap rest = overlap(model, body.diagonal, {}, tree, {}, 1000, used);
  EXPECT_NEAR(rest.match, 0.5, 0.05);
  EXPECT_LT(rest.conflict, 0.01);
  const auto marks = samples_on_model(tree, body.diagonal, {}, model, {}, 1000, used);
  for (std::size_t i = 0; i < used.size(); ++i) EXPECT_NE(marks[i], used[i]);
}

/// Returns samples of both sides of a square plate that is much thinner than their spacing.
SurfaceSamples plate(int count, std::mt19937_64& random) {
  std::uniform_real_distribution<float> along(0, 1);
  SurfaceSamples samples;
  samples.spacing = std::sqrt(2.0F / static_cast<float>(count));
  for (int i = 0; i < count; ++i) {
    const float side = i % 2 == 0 ? 1 : -1;
    samples.points.emplace_back(along(random), along(random), 0.002F * side);
    samples.normals.emplace_back(0, 0, side);
  }
  return samples;
}

TEST(Overlap, ThinPartsMatchOnBothSides) {
  std::mt19937_64 random(7);
  const SurfaceSamples model = plate(2000, random);
  const SurfaceSamples scene = plate(2000, random);
  const SampleTree tree(scene);
  const Overlap both = overlap(model, std::sqrt(2), {}, tree, {}, 2000);
  EXPECT_GT(both.match, 0.98);
  EXPECT_LT(both.conflict, 0.005);
  const auto marks = samples_on_model(SampleTree(model), std::sqrt(2), {}, scene, {}, 2000);
  EXPECT_GT(std::ranges::count(marks, 1), 1960);
  // The whole plate turned inside out contradicts it.
  SurfaceSamples inverted = model;
  for (Vector3f& normal : inverted.normals) normal = -normal;
  for (Vector3f& point : inverted.points) point.z() *= 10;
  EXPECT_LT(overlap(inverted, std::sqrt(2), {}, tree, {}, 2000).match, 0.02);
}

TEST(Overlap, RefinementFindsTheTruePose) {
  std::mt19937_64 random(3);
  const Body body;
  const SurfaceSamples model = body.samples(1000);
  for (const bool half : {false, true})
    for (int trial = 0; trial < 5; ++trial) {
      const Similarity truth = random_similarity(random);
      const Body seen = half ? body.half().moved(truth) : body.moved(truth);
      const SurfaceSamples scene = seen.samples(3000);
      const Similarity found = refine_pose(
          model, body.diagonal, shaken(truth, body.diagonal, random), SampleTree(scene), {});
      EXPECT_LT(rotation_between(found.rotation, truth.rotation), half ? 0.01 : 0.004);
      EXPECT_NEAR(found.scale / truth.scale, 1, half ? 0.01 : 0.004);
      EXPECT_LT((found.translation - truth.translation).norm(),
                (half ? 0.01 : 0.003) * body.diagonal * truth.scale);
    }
}

// A plane fixes neither the place on it nor the turn about its normal nor the scale.
TEST(Overlap, RefinementLeavesWhatTheSceneDoesNotFix) {
  Body sheet;
  const TriangleMesh plane = shapes::plane(1, 10);
  sheet.points.clear();
  for (const Vector3d& p : plane.points) sheet.points.push_back(p.cast<float>());
  sheet.triangles = plane.triangles;
  sheet.normals.assign(sheet.points.size(), Vector3f(0, 0, 1));
  const SurfaceSamples samples = sheet.samples(1000);
  Similarity start;
  start.translation = {0.05, 0.02, 0.03};
  const Similarity found = refine_pose(samples, std::sqrt(2), start, SampleTree(samples), {});
  EXPECT_NEAR(found.translation.z(), 0, 1e-3);
  EXPECT_NEAR(found.translation.x(), 0.05, 1e-3);
  EXPECT_NEAR(found.translation.y(), 0.02, 1e-3);
  EXPECT_NEAR(found.scale, 1, 1e-3);
  EXPECT_LT(rotation_between(found.rotation, Eigen::Matrix3d::Identity()), 1e-3);
}

TEST(Overlap, NothingNearNothingMoved) {
  const Body body;
  const SurfaceSamples samples = body.samples(300);
  Similarity away;
  away.translation = {0, 0, 50};
  const Similarity found = refine_pose(samples, body.diagonal, away, SampleTree(samples), {});
  EXPECT_EQ(found.translation, away.translation);
  EXPECT_EQ(found.scale, away.scale);
}

TEST(SampleTree, FindsAllSamplesWithinALimit) {
  const SurfaceSamples samples =
      sample_surface(Body().points, Body().triangles, Body().normals, 500);
  const SampleTree tree(samples);
  std::vector<std::uint32_t> found;
  for (const std::size_t at : {0, 7, 300}) {
    std::vector<std::uint32_t> near;
    for (std::uint32_t i = 0; i < 500; ++i)
      if ((samples.points[i] - samples.points[at]).norm() < 0.3F) near.push_back(i);
    tree.within(samples.points[at], 0.3F, found);
    EXPECT_EQ(found, near);
    EXPECT_GT(found.size(), 1);
  }
}

}  // namespace
}  // namespace semigeo::kernels
