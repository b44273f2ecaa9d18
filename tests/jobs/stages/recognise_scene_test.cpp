#include "jobs/stages/recognise_scene.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
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

  Recognition look_at(TriangleMesh mesh, const Similarity& pose) {
    for (Vector3d& p : mesh.points) p = pose.apply(p);
    const kernels::RecognitionModel scene =
        recognition_model(kernels::build_surface(std::move(mesh)), scene_parameters({}), context_);
    return recognise_scene(*library_, scene, {}, context_);
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

}  // namespace
}  // namespace semigeo::jobs
