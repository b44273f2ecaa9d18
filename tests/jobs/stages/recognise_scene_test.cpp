#include "jobs/stages/recognise_scene.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>
#include <optional>
#include <random>

#include "jobs/stages/recognition_features.hpp"
#include "kernels/repair/surface_builder.hpp"
#include "tests/io/library/sample_library.hpp"
#include "tests/support/random_similarity.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

using Eigen::Vector3d;
using kernels::Similarity;
using kernels::TriangleMesh;

constexpr double kDegree = std::numbers::pi / 180;

/// A sphere with bumps and dents, of its own for each seed; its vertices where `turn` has them.
TriangleMesh body(std::uint64_t seed, int levels, const Eigen::Matrix3d& turn) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> height(0.1, 0.3);
  std::vector<std::pair<Vector3d, double>> bumps;
  for (int i = 0; i < 14; ++i)
    bumps.emplace_back(random_direction(random), (i % 3 == 0 ? -1 : 1) * height(random));
  TriangleMesh mesh = shapes::icosphere(levels);
  for (Vector3d& p : mesh.points) {
    const Vector3d u = turn * p;
    double radius = 1;
    for (const auto& [at, h] : bumps) radius += h * std::exp(-12 * (u - at).squaredNorm());
    p = radius * u;
  }
  return mesh;
}

/// A slender body of revolution with a small handle; its vertices where `turn` has them.
TriangleMesh cup(int levels, const Eigen::Matrix3d& turn) {
  TriangleMesh mesh = shapes::icosphere(levels);
  for (Vector3d& p : mesh.points) {
    const Vector3d u = turn * p;
    const double wave = 1 + 0.15 * std::sin(7 * u.z());
    const double handle = 0.25 * std::exp(-80 * (u - Vector3d(1, 0, 0)).squaredNorm());
    p = (wave + handle) * u.cwiseProduct(Vector3d(0.6, 0.6, 1.3));
  }
  return mesh;
}

class RecogniseSceneTest : public testing::Test {
 protected:
  /// A library of these objects.
  void learn(const std::vector<TriangleMesh>& objects) {
    tests::SampleLibrary sample(0);
    for (std::size_t i = 0; i < objects.size(); ++i) {
      kernels::RecognitionModel model =
          recognition_model(kernels::build_surface(TriangleMesh(objects[i])), {}, context_);
      model.name = tests::generated_name(static_cast<int>(i));
      model.digest = std::string(32, '0');
      sample.triplets.push_back(kernels::local_triplets(model.features, {}));
      sample.models.push_back(std::move(model));
    }
    sample.post();
    tests::write_library(folder_ / "library.h5", sample);
    library_.emplace(folder_ / "library.h5");
  }

  kernels::RecognitionModel scene_of(TriangleMesh mesh) {
    return recognition_model(kernels::build_surface(std::move(mesh)), scene_parameters({}),
                             context_);
  }

  Recognition look_at(TriangleMesh mesh, const Similarity& pose,
                      const RecognitionOptions& options = {}) {
    for (Vector3d& p : mesh.points) p = pose.apply(p);
    return recognise_scene(*library_, scene_of(std::move(mesh)), options, context_);
  }

  tests::TemporaryFolder folder_;
  engine::Workers workers_{2};
  engine::Observer observer_;
  engine::RunContext context_{workers_, observer_, {}};
  std::optional<io::HashLibrary> library_;
};

/// Eighty vertices, half of an object that the library has a fine scan of: too few triplets, or
/// none, are right.
TEST_F(RecogniseSceneTest, HalvesOfCoarseScansAreFound) {
  constexpr int kObjects = 10;
  std::mt19937_64 random(4);
  std::vector<TriangleMesh> objects;
  for (int seed = 0; seed < kObjects; ++seed)
    objects.push_back(body(seed, 4, Eigen::Matrix3d::Identity()));
  learn(objects);
  int right = 0;
  for (int seed = 0; seed < kObjects; ++seed) {
    TriangleMesh half = body(seed, 2, random_similarity(random).rotation);
    const Vector3d up = random_direction(random);
    std::erase_if(half.triangles, [&](const auto& t) { return half.points[t[0]].dot(up) < 0; });
    const Similarity pose = random_similarity(random);
    const Recognition recognition = look_at(half, pose);
    if (recognition.ranking.empty()) continue;
    const Candidate& first = recognition.ranking.front();
    if (first.model == seed && std::abs(first.pose.scale / pose.scale - 1) < 0.1 &&
        kernels::rotation_between(first.pose.rotation, pose.rotation) < 10 * kDegree)
      ++right;
  }
  EXPECT_GE(right, 5);  // by triplets alone 2
}

/// Where the handle is decides, though nearly all of the surface fits with it anywhere.
TEST_F(RecogniseSceneTest, HandlesAreFoundWhereTheyAre) {
  std::mt19937_64 random(5);
  learn({cup(4, Eigen::Matrix3d::Identity()), body(1, 4, Eigen::Matrix3d::Identity())});
  for (int trial = 0; trial < 4; ++trial) {
    TriangleMesh scene = cup(4, random_similarity(random).rotation);
    shapes::add_noise(scene, 0.02, trial);
    const Similarity pose = random_similarity(random);
    const Recognition recognition = look_at(scene, pose);
    ASSERT_FALSE(recognition.objects.empty());
    EXPECT_EQ(recognition.objects.front().model, 0);
    EXPECT_LT(kernels::rotation_between(recognition.objects.front().pose.rotation, pose.rotation),
              5 * kDegree);
  }
}

/// Adds the triangles of a mesh that face upwards and lie where x > least, at a place.
void add_seen_from_above(const TriangleMesh& mesh, double least, const Vector3d& place,
                         TriangleMesh& scene) {
  const auto first = static_cast<std::int32_t>(scene.points.size());
  for (const Vector3d& p : mesh.points) scene.points.push_back(p + place);
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3d normal =
        (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]);
    if (normal.z() > 0.25 * normal.norm() && mesh.points[a].x() > least)
      scene.triangles.push_back({first + a, first + b, first + c});
  }
}

/// From above one sees a quarter of one body, and the upper sides of four others.
TEST_F(RecogniseSceneTest, WhatIsHiddenFromOnePlaceSaysNothingAgainstAnObject) {
  std::vector<TriangleMesh> objects;
  for (int seed = 0; seed < 6; ++seed)
    objects.push_back(body(seed, 5, Eigen::Matrix3d::Identity()));
  learn(objects);
  TriangleMesh mesh;
  add_seen_from_above(objects[0], -0.1, Vector3d::Zero(), mesh);
  for (int other = 1; other < 5; ++other)
    add_seen_from_above(objects[other], -2, Vector3d(3.0 * other, 0, -other), mesh);
  kernels::RecognitionModel scene = scene_of(mesh);
  const auto has_first = [&](const Recognition& recognition) {
    return std::ranges::any_of(recognition.objects, [](const Candidate& object) {
      return object.model == 0 &&
             kernels::rotation_between(object.pose.rotation, Eigen::Matrix3d::Identity()) < kDegree;
    });
  };
  EXPECT_FALSE(has_first(recognise_scene(*library_, scene, {}, context_)));
  scene.eye = Vector3d(0, 0, 1000);
  const Recognition seen = recognise_scene(*library_, scene, {}, context_);
  EXPECT_TRUE(has_first(seen));
  EXPECT_EQ(seen.objects.size(), 5);
}

/// A torus has no features but those of rounding and of its triangles, which are taken away. Then
/// no triplet tells where it is. Its curvature does.
TEST_F(RecogniseSceneTest, WithoutFeaturesItIsFoundByItsCurvature) {
  std::vector<TriangleMesh> objects;
  for (int seed = 0; seed < 3; ++seed)
    objects.push_back(body(seed, 5, Eigen::Matrix3d::Identity()));
  objects.push_back(shapes::torus(1, 0.4, 100, 50));
  learn(objects);
  TriangleMesh mesh;
  add_seen_from_above(objects[0], -2, Vector3d::Zero(), mesh);
  const Similarity pose{.scale = 0.8,
                        .rotation = Eigen::AngleAxisd(0.7, Vector3d::UnitX()).toRotationMatrix(),
                        .translation = Vector3d::Zero()};
  TriangleMesh torus = shapes::torus(1, 0.4, 87, 37, 0.2);
  for (Vector3d& p : torus.points) p = pose.apply(p);
  const Vector3d place(3, 0, 0);
  add_seen_from_above(torus, -2, place, mesh);
  kernels::RecognitionModel scene = scene_of(mesh);
  std::erase_if(scene.features.features,
                [](const kernels::OrientedFeature& feature) { return feature.position.x() > 1.5; });
  scene.eye = Vector3d(0, 0, 1000);
  RecognitionOptions two_looks;
  two_looks.tuning.third_look.most_models = 0;
  EXPECT_EQ(recognise_scene(*library_, scene, two_looks, context_).objects.size(), 1);
  const Recognition seen = recognise_scene(*library_, scene, {}, context_);
  ASSERT_EQ(seen.objects.size(), 2);
  const auto found = std::ranges::find(seen.objects, 3, &Candidate::model);
  ASSERT_NE(found, seen.objects.end());
  EXPECT_NEAR(found->pose.scale, 0.8, 0.02);
  EXPECT_LT((found->pose.translation - place).norm(), 0.03);
  EXPECT_GT(std::abs(found->pose.rotation.col(2).dot(pose.rotation.col(2))), std::cos(kDegree));
}

TEST_F(RecogniseSceneTest, ObjectsOfOtherSizesAreLeftOut) {
  learn({body(0, 4, Eigen::Matrix3d::Identity()), body(1, 4, Eigen::Matrix3d::Identity())});
  std::mt19937_64 random(6);
  Similarity pose = random_similarity(random);
  pose.scale = 1.05;
  const RecognitionOptions known{.scale = {0.9, 1.1}};
  const TriangleMesh object = body(0, 4, random_similarity(random).rotation);
  const Recognition found = look_at(object, pose, known);
  ASSERT_EQ(found.objects.size(), 1);
  EXPECT_EQ(found.objects.front().model, 0);
  EXPECT_NEAR(found.objects.front().pose.scale, 1.05, 0.01);
  pose.scale = 1.5;
  EXPECT_EQ(look_at(object, pose).objects.size(), 1);
  const Recognition other = look_at(object, pose, known);
  EXPECT_TRUE(other.objects.empty());
  for (const Candidate& candidate : other.ranking)
    EXPECT_TRUE(known.scale.has(candidate.pose.scale));
}

}  // namespace
}  // namespace semigeo::jobs
