#include "jobs/stages/thesis_recognition.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "tests/io/library/sample_library.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

using kernels::FeatureKind;
using kernels::OrientedFeature;
using kernels::RecognitionModel;

/// Features of all four kinds, anywhere in a box; level 1 is the one that is looked at.
RecognitionModel random_model(int index, int of_each_kind = 15) {
  std::mt19937_64 random(index);
  std::uniform_real_distribution<float> place(-1, 1), value(0.2F, 2);
  RecognitionModel model;
  model.name = tests::generated_name(index);
  model.digest = std::string(32, '0');
  model.origin = {100.0 * index, 3, 0};
  model.diagonal = 2 * std::sqrt(3.0F);
  model.features.level_scale = {0.1F, 0.2F};
  for (int level = 0; level < 2; ++level)
    for (int kind = 0; kind < kernels::kFeatureKinds; ++kind)
      for (int i = 0; i < of_each_kind; ++i) {
        OrientedFeature feature;
        for (int c = 0; c < 3; ++c) feature.position[c] = place(random);
        feature.normal = Eigen::Vector3f(place(random), place(random), place(random)).normalized();
        feature.value = (random() % 2 == 0 ? 1.0F : -1.0F) * value(random);
        feature.code = kernels::feature_code(static_cast<FeatureKind>(kind), feature.value > 0);
        feature.level = static_cast<std::uint8_t>(level);
        model.features.features.push_back(feature);
      }
  return model;
}

/// Where the model of a scene is; `model` in coordinates of its file.
RecognitionModel moved(const RecognitionModel& model, const kernels::Similarity& pose) {
  RecognitionModel scene = model;
  scene.origin = {-7, 8, 9};
  for (OrientedFeature& feature : scene.features.features) {
    const Eigen::Vector3d p = pose.apply(feature.position.cast<double>() + model.origin);
    feature.position = (p - scene.origin).cast<float>();
    feature.normal = (pose.rotation * feature.normal.cast<double>()).cast<float>();
  }
  return scene;
}

kernels::Similarity some_pose() {
  kernels::Similarity pose;
  pose.scale = 1.7;
  pose.rotation =
      Eigen::AngleAxisd(2.2, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  pose.translation = {30, -10, 4};
  return pose;
}

class ThesisRecognitionTest : public testing::Test {
 protected:
  ThesisRecognitionTest() {
    tests::SampleLibrary sample(0);
    for (int i = 0; i < 5; ++i) sample.models.push_back(random_model(i));
    sample.triplets.resize(sample.models.size());
    tests::write_library(folder_ / "library.h5", sample);
    library_.emplace(folder_ / "library.h5");
  }

  std::vector<ThesisScore> scores(const RecognitionModel& scene, int threads = 2,
                                  const ThesisRecognitionOptions& options = {}) {
    engine::Workers workers(threads);
    engine::Observer observer;
    const engine::RunContext context{workers, observer, {}};
    return ThesisDatabase(*library_, options, context).scores(scene);
  }

  tests::TemporaryFolder folder_;
  std::optional<io::HashLibrary> library_;
};

TEST_F(ThesisRecognitionTest, NamesTheModelAndItsPose) {
  for (const int index : {0, 3}) {
    const auto found = scores(moved(random_model(index), some_pose()));
    const Recognition recognition = ranked(found, {});
    ASSERT_FALSE(recognition.objects.empty());
    EXPECT_EQ(recognition.objects.size(), 1);
    const Candidate& best = recognition.ranking.front();
    EXPECT_EQ(best.model, index);
    EXPECT_EQ(recognition.objects[0].model, index);
    EXPECT_NEAR(best.pose.scale, 1.7, 0.01);
    EXPECT_LT(kernels::rotation_between(best.pose.rotation, some_pose().rotation), 0.01);
    const Eigen::Vector3d at = random_model(index).origin;
    EXPECT_LT((best.pose.apply(at) - some_pose().apply(at)).norm(), 0.05);
    // Every triplet that is not collinear finds itself, in every table.
    for (const double score : found[index].of_kind) EXPECT_GT(score, 90);
    EXPECT_GE(found[index].cluster, 4 * 455 * 9 / 10);
  }
}

TEST_F(ThesisRecognitionTest, TheTotalIsTheMeanOfTheKinds) {
  for (const ThesisScore& score : scores(random_model(1))) {
    double sum = 0;
    for (const double of_kind : score.of_kind) sum += of_kind;
    EXPECT_NEAR(score.total, sum / 4, 1e-9);
  }
}

TEST_F(ThesisRecognitionTest, KindsDoNotMixAndOtherLevelsDoNotCount) {
  RecognitionModel scene = random_model(1);
  std::erase_if(scene.features.features, [](const OrientedFeature& feature) {
    return feature.level == 1 && feature.code / 2 != static_cast<int>(FeatureKind::kMean);
  });
  const auto found = scores(scene);
  for (const ThesisScore& score : found) {
    EXPECT_EQ(score.of_kind[0] + score.of_kind[2] + score.of_kind[3], 0);
  }
  EXPECT_GT(found[1].of_kind[1], 90);
}

TEST_F(ThesisRecognitionTest, OnlySurvivorsAreVerified) {
  ThesisRecognitionOptions options;
  options.survivors = 0.999;
  const auto found = scores(random_model(2), 2, options);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].survives, i == 2);
    EXPECT_EQ(found[i].cluster > 0, i == 2);
  }
}

TEST_F(ThesisRecognitionTest, DoesNotDependOnTheNumberOfThreads) {
  const RecognitionModel scene = moved(random_model(4), some_pose());
  const auto one = scores(scene, 1), two = scores(scene, 2);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].of_kind, two[i].of_kind);
    EXPECT_EQ(one[i].cluster, two[i].cluster);
    EXPECT_EQ(one[i].pose.rotation, two[i].pose.rotation);
  }
}

TEST_F(ThesisRecognitionTest, NothingIsInAnEmptyScene) {
  const Recognition recognition = ranked(scores({}), {});
  EXPECT_TRUE(recognition.ranking.empty());
  EXPECT_TRUE(recognition.objects.empty());
}

}  // namespace
}  // namespace semigeo::jobs
