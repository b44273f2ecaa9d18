#pragma once

#include <cstdint>
#include <random>

#include "kernels/recognition/triplet.hpp"
#include "tests/support/random_similarity.hpp"

namespace semigeo {

/// Features of one level, of scale 1, at random places of a cube that is 20 wide.
inline kernels::OrientedFeatures random_features(int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> uniform(-1, 1);
  kernels::OrientedFeatures result;
  result.level_scale = {1};
  for (int i = 0; i < count; ++i) {
    kernels::OrientedFeature feature;
    feature.position = 10 * Eigen::Vector3f(uniform(random), uniform(random), uniform(random));
    feature.normal = random_direction(random).cast<float>();
    feature.scale_free_gaussian = uniform(random);
    feature.scale_free_mean = uniform(random);
    feature.code = kernels::feature_code(
        i % 2 == 0 ? kernels::FeatureKind::kGaussian : kernels::FeatureKind::kMean,
        uniform(random) > 0);
    result.features.push_back(feature);
  }
  return result;
}

inline kernels::OrientedFeatures moved(kernels::OrientedFeatures features,
                                       const kernels::Similarity& similarity) {
  for (kernels::OrientedFeature& feature : features.features) {
    feature.position = similarity.apply(feature.position.cast<double>()).cast<float>();
    feature.normal = (similarity.rotation * feature.normal.cast<double>()).cast<float>();
  }
  for (float& scale : features.level_scale) scale *= static_cast<float>(similarity.scale);
  return features;
}

}  // namespace semigeo
