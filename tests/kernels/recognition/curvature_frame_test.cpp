#include "kernels/recognition/curvature_frame.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "kernels/recognition/surface_samples.hpp"
#include "tests/support/random_similarity.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::kernels {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kMajor = 1;
constexpr double kMinor = 0.4;

/// Returns the point of the torus' middle circle that is nearest to a point.
Vector3d ring(const Vector3d& p) {
  return kMajor * Vector3d(p.x(), p.y(), 0).normalized();
}

/// Samples a mesh in a pose. `normal_at` has its normals.
template <typename NormalAt>
SurfaceSamples samples_of(const TriangleMesh& mesh, const NormalAt& normal_at, std::int64_t count,
                          const Similarity& pose = {}) {
  std::vector<Vector3f> points;
  std::vector<Vector3f> normals;
  for (const Vector3d& p : mesh.points) {
    points.push_back(pose.apply(p).cast<float>());
    normals.push_back((pose.rotation * normal_at(p).normalized()).template cast<float>());
  }
  return sample_surface(points, mesh.triangles, normals, count);
}

Vector3d torus_normal(const Vector3d& p) {
  return p - ring(p);
}

SurfaceSamples torus(std::int64_t count, const Similarity& pose = {}) {
  return samples_of(shapes::torus(kMajor, kMinor, 120, 60, 0.2), torus_normal, count, pose);
}

/// Leaves the samples that face a direction.
SurfaceSamples facing(const SurfaceSamples& all, const Vector3f& direction) {
  SurfaceSamples result{.points = {}, .normals = {}, .spacing = all.spacing};
  for (std::size_t i = 0; i < all.points.size(); ++i)
    if (all.normals[i].dot(direction) > 0.2F) {
      result.points.push_back(all.points[i]);
      result.normals.push_back(all.normals[i]);
    }
  return result;
}

TEST(CurvatureFrames, ATorusHasItsCurvaturesAndDirections) {
  const SurfaceSamples samples = torus(4000);
  const auto frames = curvature_frames(SampleTree(samples), {});
  ASSERT_EQ(frames.size(), 300);
  for (const CurvatureFrame& frame : frames) {
    const Vector3d p = frame.point.cast<double>();
    const double across = Vector3d(p.x(), p.y(), 0).norm();
    EXPECT_NEAR(frame.curvature, 1 / kMinor, 0.1 / kMinor);
    EXPECT_NEAR(frame.ratio, (across - kMajor) / across, 0.08);
    const Vector3d along = Vector3d::UnitZ().cross(ring(p)).normalized();
    EXPECT_LT(std::abs(frame.direction.cast<double>().dot(along)), 0.1);
    EXPECT_NEAR(frame.direction.norm(), 1, 1e-5);
    EXPECT_NEAR(frame.direction.dot(frame.normal), 0, 1e-5);
  }
}

TEST(CurvatureFrames, TheInsideOfATorusIsHollow) {
  SurfaceSamples samples = torus(4000);
  for (Vector3f& normal : samples.normals) normal *= -1;
  for (const CurvatureFrame& frame : curvature_frames(SampleTree(samples), {}))
    EXPECT_NEAR(frame.curvature, -1 / kMinor, 0.1 / kMinor);
}

TEST(CurvatureFrames, SpheresAndPlanesHaveNone) {
  const SurfaceSamples sphere = samples_of(
      shapes::icosphere(5), [](const Vector3d& p) { return p; }, 4000);
  EXPECT_TRUE(curvature_frames(SampleTree(sphere), {}).empty());
  const SurfaceSamples plane = samples_of(
      shapes::plane(2, 40), [](const Vector3d&) { return Vector3d(Vector3d::UnitZ()); }, 4000);
  EXPECT_TRUE(curvature_frames(SampleTree(plane), {}).empty());
  EXPECT_TRUE(votes_of_frames({}, {}, 0.1).empty());
}

TEST(CurvatureFrames, UsedSamplesAndRimsHaveNone) {
  SurfaceSamples samples = torus(4000);
  std::vector<std::uint8_t> used(samples.points.size());
  samples.rim.resize(samples.points.size());
  for (std::size_t i = 0; i < used.size(); ++i) {
    used[i] = samples.points[i].x() > 0 ? 1 : 0;
    samples.rim[i] = samples.points[i].y() > 0 ? 1 : 0;
  }
  const auto frames = curvature_frames(SampleTree(samples), {}, used);
  ASSERT_FALSE(frames.empty());
  for (const CurvatureFrame& frame : frames) {
    EXPECT_LE(frame.point.x(), 0);
    EXPECT_LE(frame.point.y(), 0);
  }
}

TEST(CurvatureFrames, SimilaritiesTakeFrameToFrame) {
  std::mt19937_64 random(3);
  const Similarity pose = random_similarity(random);
  const CurvatureFrame from = {.point = {1, 2, 3},
                               .normal = Vector3f(0, 0.6F, 0.8F),
                               .direction = Vector3f(0, 0.8F, -0.6F),
                               .curvature = -2,
                               .ratio = 0.3F};
  const auto turned = [&](const Vector3f& v) -> Vector3f {
    return (pose.rotation * v.cast<double>()).cast<float>();
  };
  const CurvatureFrame to = {.point = pose.apply(from.point.cast<double>()).cast<float>(),
                             .normal = turned(from.normal),
                             .direction = -turned(from.direction),
                             .curvature = static_cast<float>(from.curvature / pose.scale),
                             .ratio = from.ratio};
  const auto found = similarities_between(from, to);
  for (const Similarity& s : found) {
    EXPECT_NEAR(s.scale, pose.scale, 1e-5);
    EXPECT_LT((s.apply(from.point.cast<double>()) - to.point.cast<double>()).norm(), 1e-4);
    EXPECT_LT((s.rotation * from.normal.cast<double>() - to.normal.cast<double>()).norm(), 1e-5);
  }
  EXPECT_LT(rotation_between(found[1].rotation, pose.rotation), 1e-4);
  EXPECT_NEAR(rotation_between(found[0].rotation, pose.rotation), std::acos(-1.0), 1e-4);
}

/// One side of a torus says where the whole torus is, up to turns about its axis.
TEST(CurvatureFrames, ATorusIsFoundFromOneSide) {
  const SurfaceSamples model = torus(4000);
  const auto of_model = curvature_frames(SampleTree(model), {});
  std::mt19937_64 random(4);
  for (int trial = 0; trial < 5; ++trial) {
    const Similarity truth = random_similarity(random);
    const SurfaceSamples scene = facing(torus(9000, truth), random_direction(random).cast<float>());
    const auto votes =
        votes_of_frames(curvature_frames(SampleTree(scene), {.radius = 5}), of_model, 0.06);
    const double diagonal = 2 * (kMajor + kMinor) * std::sqrt(2.0) + 2 * kMinor;
    const auto clusters =
        PoseVotes(votes, Vector3d::Zero(), diagonal).clusters({.seeds = 600, .most = 1});
    ASSERT_EQ(clusters.size(), 1);
    const Similarity& pose = clusters.front().pose;
    EXPECT_NEAR(pose.scale / truth.scale, 1, 0.05);
    EXPECT_LT((pose.translation - truth.translation).norm(), 0.1 * truth.scale);
    EXPECT_GT(std::abs(pose.rotation.col(2).dot(truth.rotation.col(2))), std::cos(0.12));
  }
}

}  // namespace
}  // namespace semigeo::kernels
