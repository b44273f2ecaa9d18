#include "kernels/recognition/depth_map.hpp"

#include <gtest/gtest.h>

#include "kernels/recognition/overlap.hpp"
#include "kernels/recognition/surface_samples.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::kernels {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Samples of the square |x|, |y| < 1 at height z, facing upwards.
void add_plate(float z, SurfaceSamples& samples) {
  constexpr int kSide = 60;
  samples.spacing = 2.0F / kSide;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      const float x = (static_cast<float>(i) + 0.5F) * samples.spacing - 1;
      const float y = (static_cast<float>(j) + 0.5F) * samples.spacing - 1;
      samples.points.emplace_back(x, y, z);
      samples.normals.emplace_back(0, 0, 1);
    }
}

SurfaceSamples plate() {
  SurfaceSamples samples;
  add_plate(0, samples);
  return samples;
}

TEST(DepthMapTest, TellsWhatWasSeenAlongARay) {
  const SurfaceSamples samples = plate();
  const DepthMap map(samples, Vector3d(0.5, -0.5, 5));
  for (const float x : {-0.9F, 0.0F, 0.7F})
    for (const float y : {-0.8F, 0.1F, 0.9F}) {
      EXPECT_EQ(map.look({x, y, 0}, 0.1F), Sight::kThere);
      EXPECT_EQ(map.look({x, y, 0.05F}, 0.1F), Sight::kThere);
      EXPECT_EQ(map.look({x, y, -0.5F}, 0.1F), Sight::kInFront);
    }
  EXPECT_EQ(map.look({0.2F, 0.1F, 0.5F}, 0.1F), Sight::kBehind);
  EXPECT_EQ(map.look({1.5F, 0, 0}, 0.1F), Sight::kNothing);
  EXPECT_EQ(map.look({0, 0, 6}, 0.1F), Sight::kUnmapped);   // behind the scanner
  EXPECT_EQ(map.look({90, 0, 0}, 0.1F), Sight::kUnmapped);  // too far from the middle
}

TEST(DepthMapTest, WorksFromFarAway) {
  const SurfaceSamples samples = plate();
  const DepthMap map(samples, Vector3d(0, 0, 300));
  EXPECT_EQ(map.look({0.9F, 0.9F, 0}, 0.05F), Sight::kThere);
  EXPECT_EQ(map.look({0.5F, -0.9F, 0.3F}, 0.05F), Sight::kBehind);
  EXPECT_EQ(map.look({0.5F, -0.9F, -0.3F}, 0.05F), Sight::kInFront);
  EXPECT_EQ(map.look({1.2F, 0, 0}, 0.05F), Sight::kNothing);
}

TEST(DepthMapTest, SaysForASurfaceWithTwoDepthsWhichOneIsSeen) {
  SurfaceSamples samples = plate();
  const std::size_t first = samples.points.size();
  add_plate(-2, samples);
  for (std::size_t i = first; i < samples.points.size(); ++i) samples.points[i].x() += 2;
  const DepthMap map(samples, Vector3d(0, 0, 100));
  EXPECT_EQ(map.look({0.5F, 0, 0}, 0.1F), Sight::kThere);
  EXPECT_EQ(map.look({0.5F, 0, -2}, 0.1F), Sight::kInFront);
  EXPECT_EQ(map.look({2, 0, -2}, 0.1F), Sight::kThere);
  EXPECT_EQ(map.look({2, 0, 0}, 0.1F), Sight::kBehind);
}

TEST(DepthMapTest, WithoutSamplesKnowsNothing) {
  const DepthMap map({}, Vector3d(0, 0, 5));
  EXPECT_NE(map.look({0, 0, 0}, 0.1F), Sight::kThere);
}

/// Of a sphere that is seen from far away, the half that faces the scanner should be seen.
TEST(OverlapViewTest, HiddenAndFarSidesDoNotCount) {
  const TriangleMesh sphere = shapes::icosphere(4);
  std::vector<Vector3f> points;
  for (const Vector3d& p : sphere.points) points.push_back(p.cast<float>());
  const SurfaceSamples model = sample_surface(points, sphere.triangles, points, 4000);
  SurfaceSamples scene{.points = {}, .normals = {}, .spacing = model.spacing};
  for (std::size_t i = 0; i < model.points.size(); ++i)
    if (model.normals[i].z() > 0.05F) {
      scene.points.push_back(model.points[i]);
      scene.normals.push_back(model.normals[i]);
    }
  scene.rim.assign(scene.points.size(), 1);
  const DepthMap map(scene, Vector3d(0, 0, 200));
  const SampleTree tree(scene);
  OverlapOptions options;
  options.depths = &map;
  const auto view_at = [&](const Vector3d& place) {
    return overlap(model, 2 * std::sqrt(3.0), {.translation = place}, tree, options, 4000).view;
  };
  const View right = view_at(Vector3d::Zero());
  EXPECT_NEAR(right.there, 0.5 * (1 - 0.35), 0.02);  // those that face it by less than 70 degrees
  EXPECT_EQ(right.behind, 0);
  EXPECT_EQ(right.nothing, 0);
  EXPECT_LT(right.opposed, 0.005);
  const View before = view_at({0, 0, 1});
  EXPECT_GT(before.behind, 0.2);
  const View behind = view_at({0, 0, -1});
  EXPECT_EQ(behind.behind, 0);
  EXPECT_LT(behind.visible(), 0.1);
  EXPECT_NEAR(view_at({5, 0, 0}).nothing, 0.5 * (1 - 0.35), 0.02);
}

/// Of a plate with a bevel along one side, the face alone was seen. The bevel lies where its rim
/// is, and faces another way.
TEST(OverlapViewTest, WhatLiesAtARimIsNotOpposed) {
  SurfaceSamples scene = plate();
  SurfaceSamples model = scene;
  std::size_t bevel = 0;
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    if (scene.points[i].x() < 0.97F) continue;
    model.normals[i] = Vector3f(1, 0, 1).normalized();
    ++bevel;
  }
  const DepthMap map(scene, Vector3d(0, 0, 200));
  const SampleTree tree(scene);
  OverlapOptions options;
  options.depths = &map;
  const auto opposed = [&](auto rim) {
    scene.rim.resize(scene.points.size());
    for (std::size_t i = 0; i < scene.points.size(); ++i)
      scene.rim[i] = rim(scene.points[i]) ? 1 : 0;
    return overlap(model, std::sqrt(8.0), {}, tree, options, 4000).view.opposed;
  };
  const double share = static_cast<double>(bevel) / static_cast<double>(model.points.size());
  EXPECT_EQ(opposed([](const Vector3f& p) { return p.x() > 0.97F; }), 0);
  EXPECT_NEAR(opposed([](const Vector3f& p) { return p.x() < -0.97F; }), share, 1e-9);
}

}  // namespace
}  // namespace semigeo::kernels
