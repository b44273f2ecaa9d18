#include "bench/recognition/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "bench/support/mesh_changes.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::recognition {
namespace {

BenchModels three_models() {
  BenchModels models;
  models.push_back(make_model("torus", shapes::rough_torus(10), 1000));
  models.push_back(make_model("sphere", shapes::icosphere(3, 0.2), 0));
  models.push_back(make_model("cube", shapes::cube(3, 8), 0));
  return models;
}

const SceneKind& kind(const char* name) {
  return *scene_kind(name);
}

TEST(MakeModel, DecimatesToTheMostVerticesAndMeasuresTheBox) {
  const auto model = make_model("cube", shapes::cube(3, 8), 100);
  EXPECT_LE(model->mesh.points.size(), 100);
  EXPECT_GT(model->mesh.points.size(), 90);
  EXPECT_LT(model->centre.norm(), 0.05);
  EXPECT_NEAR(model->diagonal, 3 * std::sqrt(3.0), 0.05);
  EXPECT_EQ(make_model("none", {}, 100), nullptr);
}

TEST(MakeScene, AsItIsPutsEveryVertexWhereThePoseSays) {
  const BenchModels models = three_models();
  const Scene scene = make_scene(kind("A"), models, 0, 1);
  ASSERT_EQ(scene.objects.size(), 1);
  ASSERT_EQ(scene.mesh.points.size(), models[0]->mesh.points.size());
  for (std::size_t v = 0; v < scene.mesh.points.size(); ++v)
    EXPECT_LT(
        (scene.mesh.points[v] - scene.objects[0].pose.apply(models[0]->mesh.points[v])).norm(),
        1e-9);
}

TEST(MakeScene, KeepsTheSharesOfItsKind) {
  const BenchModels models = three_models();
  const auto vertices = static_cast<double>(models[0]->mesh.points.size());
  const auto share = [&](const char* name) {
    return static_cast<double>(make_scene(kind(name), models, 0, 1).mesh.points.size()) / vertices;
  };
  EXPECT_NEAR(share("B"), 0.4, 0.03);
  EXPECT_NEAR(share("C"), 0.6, 0.005);
  EXPECT_NEAR(share("D"), 0.3, 0.03);
  EXPECT_NEAR(share("E"), 0.6, 0.005);
  EXPECT_NEAR(share("B70"), 0.3, 0.03);
}

TEST(MakeScene, NoiseIsAShareOfTheEdgesThatAreThere) {
  const BenchModels models = three_models();
  const Scene with = make_scene(kind("E"), models, 0, 1);
  SceneKind clean = kind("E");
  clean.noise = 0;
  const Scene without = make_scene(clean, models, 0, 1);
  double squares = 0;
  for (std::size_t v = 0; v < with.mesh.points.size(); ++v)
    squares += (bench::undo(with.objects[0].pose, with.mesh.points[v]) -
                bench::undo(without.objects[0].pose, without.mesh.points[v]))
                   .squaredNorm() /
               3;
  const double sigma = std::sqrt(squares / static_cast<double>(with.mesh.points.size()));
  EXPECT_NEAR(sigma * without.objects[0].pose.scale / bench::mean_edge_length(without.mesh), 0.15,
              0.005);
}

TEST(MakeScene, ThreeDifferentObjectsOfComparableSizeAreWhereTheirPosesSay) {
  const BenchModels models = three_models();
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Scene scene = make_scene(kind("F"), models, 1, seed);
    ASSERT_EQ(scene.objects.size(), 3);
    EXPECT_EQ(scene.objects[0].model, 1);
    std::set<std::size_t> different;
    double smallest = 1e9, largest = 0;
    std::size_t vertex = 0;
    for (const PlacedObject& object : scene.objects) {
      different.insert(object.model);
      const BenchModel& model = *models[object.model];
      smallest = std::min(smallest, object.pose.scale * model.diagonal);
      largest = std::max(largest, object.pose.scale * model.diagonal);
      for (const Eigen::Vector3d& p : model.mesh.points) {
        EXPECT_LT((scene.mesh.points[vertex] - object.pose.apply(p)).norm(),
                  1e-9 * (1 + object.pose.translation.norm()));
        ++vertex;
      }
    }
    EXPECT_EQ(vertex, scene.mesh.points.size());
    EXPECT_EQ(different.size(), 3);
    EXPECT_LT(largest / smallest, 1.3 * 1.3 + 1e-9);
  }
}

TEST(MakeScene, CopiesAreOfOneModelInDifferentPoses) {
  const BenchModels models = three_models();
  std::set<std::size_t> counts;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Scene scene = make_scene(kind("H"), models, 2, seed);
    counts.insert(scene.objects.size());
    for (const PlacedObject& object : scene.objects) EXPECT_EQ(object.model, 2);
    EXPECT_GT((scene.objects[0].pose.rotation - scene.objects[1].pose.rotation).norm(), 0.01);
  }
  EXPECT_EQ(counts, (std::set<std::size_t>{2, 3}));
}

TEST(MakeScene, FollowsItsSeed) {
  const BenchModels models = three_models();
  const auto first = [&](std::uint64_t seed) {
    return make_scene(kind("D"), models, 0, seed).mesh.points.front();
  };
  EXPECT_EQ(first(1), first(1));
  EXPECT_NE(first(1), first(2));
}

TEST(MakeScene, NeedsAsManyModelsAsObjects) {
  BenchModels models = three_models();
  models.pop_back();
  EXPECT_THROW(make_scene(kind("F"), models, 0, 1), std::runtime_error);
}

TEST(ThesisPlacements, TurnAboutXThenYThenZ) {
  const kernels::Similarity s = similarity_of({"", 5, 90, 0, 90});
  // x: about x stays, about z to y. y: about x to z, about z stays.
  EXPECT_LT((s.apply({1, 0, 0}) - Eigen::Vector3d(0, 5, 0)).norm(), 1e-12);
  EXPECT_LT((s.apply({0, 1, 0}) - Eigen::Vector3d(0, 0, 5)).norm(), 1e-12);
  EXPECT_EQ(thesis_placements().size(), 12);
}

}  // namespace
}  // namespace semigeo::recognition
