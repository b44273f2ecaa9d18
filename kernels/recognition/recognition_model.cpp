#include "kernels/recognition/recognition_model.hpp"

namespace semigeo::kernels {

RecognitionModel turned_over(RecognitionModel model) {
  const auto of_mean = [](const OrientedFeature& feature) {
    return feature.code / 2 == static_cast<int>(FeatureKind::kMean);
  };
  for (OrientedFeature& feature : model.features.features) {
    feature.normal = -feature.normal;
    feature.scale_free_mean = -feature.scale_free_mean;
    if (!of_mean(feature)) continue;
    feature.value = -feature.value;
    feature.code = feature_code(FeatureKind::kMean, feature.value > 0);
  }
  for (Eigen::Vector3f& normal : model.samples.normals) normal = -normal;
  model.eye.reset();
  return model;
}

}  // namespace semigeo::kernels
