#include "kernels/recognition/recognition_model.hpp"

#include <gtest/gtest.h>

namespace semigeo::kernels {
namespace {

RecognitionModel model_of(FeatureKind kind, float value) {
  RecognitionModel model;
  OrientedFeature feature;
  feature.position = {1, 2, 3};
  feature.normal = {0, 0, 1};
  feature.scale_free_gaussian = -0.5F;
  feature.scale_free_mean = 0.25F;
  feature.value = value;
  feature.code = feature_code(kind, value > 0);
  model.features.features = {feature};
  model.samples.points = {{1, 2, 3}};
  model.samples.normals = {{0, 1, 0}};
  return model;
}

TEST(RecognitionModelTest, TurningOverChangesTheSignsOfNormalsAndMeanCurvature) {
  const RecognitionModel turned = turned_over(model_of(FeatureKind::kMean, 0.25F));
  const OrientedFeature& feature = turned.features.features[0];
  EXPECT_EQ(feature.position, Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(feature.normal, Eigen::Vector3f(0, 0, -1));
  EXPECT_EQ(feature.scale_free_gaussian, -0.5F);
  EXPECT_EQ(feature.scale_free_mean, -0.25F);
  EXPECT_EQ(feature.value, -0.25F);
  EXPECT_EQ(feature.code, feature_code(FeatureKind::kMean, false));
  EXPECT_EQ(turned.samples.points[0], Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(turned.samples.normals[0], Eigen::Vector3f(0, -1, 0));
}

TEST(RecognitionModelTest, GaussianCurvatureAndTorsionDoNotDependOnTheSide) {
  for (const auto kind :
       {FeatureKind::kGaussian, FeatureKind::kGaussianTorsion, FeatureKind::kMeanTorsion}) {
    const RecognitionModel turned = turned_over(model_of(kind, -2));
    EXPECT_EQ(turned.features.features[0].value, -2);
    EXPECT_EQ(turned.features.features[0].code, feature_code(kind, false));
  }
}

}  // namespace
}  // namespace semigeo::kernels
