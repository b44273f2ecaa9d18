#include "tests/support/generated_models.hpp"

#include <algorithm>
#include <tuple>

namespace semigeo::tests {
namespace {

/// SplitMix64: the same numbers everywhere, and fast.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }
  std::uint32_t below(std::uint32_t end) {
    return static_cast<std::uint32_t>((bits() >> 32) * end >> 32);
  }
  float between(float low, float high) {
    return low + (high - low) * static_cast<float>(bits() >> 40) / 16777216.0F;
  }
  Eigen::Vector3f point() { return {between(-1, 1), between(-1, 1), between(-1, 1)}; }
  Eigen::Vector3f direction() {
    for (;;) {
      const Eigen::Vector3f p = point();
      if (p.norm() > 0.1F && p.norm() < 1) return p.normalized();
    }
  }

 private:
  std::uint64_t state_;
};

}  // namespace

std::string generated_name(int index) {
  const std::string digits = std::to_string(index);
  return "model-" + std::string(6 - digits.size(), '0') + digits;
}

kernels::RecognitionModel generated_model(int index, const ModelSize& size) {
  Chance chance(static_cast<std::uint64_t>(index));
  kernels::RecognitionModel model;
  model.name = generated_name(index);
  model.digest = std::string(32, static_cast<char>('a' + index % 6));
  model.length_unit = index % 2 == 0 ? "mm" : "unknown";
  model.origin = 1e6 * chance.point().cast<double>();
  model.centre = chance.point();
  model.diagonal = chance.between(1, 9);
  model.features.level_scale = {0.1F, 0.2F, 0.5F};
  for (int i = 0; i < size.features; ++i)
    model.features.features.push_back(
        {.position = chance.point(),
         .normal = chance.direction(),
         .scale_free_gaussian = chance.between(-1, 1),
         .scale_free_mean = chance.between(-1, 1),
         .value = chance.between(-1, 1),
         .code = static_cast<std::uint8_t>(chance.below(kernels::kFeatureCodes)),
         .level = static_cast<std::uint8_t>(chance.below(3))});
  for (int i = 0; i < size.samples; ++i) {
    model.samples.points.push_back(chance.point());
    model.samples.normals.push_back(chance.direction());
  }
  model.samples.spacing = chance.between(0.01F, 0.02F);
  return model;
}

std::vector<kernels::Triplet> generated_triplets(int index, const kernels::RecognitionModel& model,
                                                 const ModelSize& size) {
  Chance chance(~static_cast<std::uint64_t>(index));
  const auto& features = model.features.features;
  std::vector<kernels::Triplet> triplets(features.empty() ? 0 : size.triplets);
  for (kernels::Triplet& triplet : triplets) {
    const std::uint32_t shape =
        (chance.below(kernels::kShapes) + chance.below(kernels::kShapes)) / 2;
    triplet.cell = shape;
    for (std::uint16_t& corner : triplet.corners) {
      corner =
          static_cast<std::uint16_t>(chance.below(static_cast<std::uint32_t>(features.size())));
      triplet.cell = triplet.cell * kernels::kFeatureCodes + features[corner].code;
    }
    for (std::uint8_t& invariant : triplet.invariants)
      invariant = static_cast<std::uint8_t>(chance.below(256));
  }
  const auto place = [](const kernels::Triplet& t) { return std::tie(t.cell, t.corners); };
  std::ranges::sort(triplets, {}, place);
  const auto is_twice = [&](const auto& a, const auto& b) { return place(a) == place(b); };
  triplets.erase(std::unique(triplets.begin(), triplets.end(), is_twice), triplets.end());
  return triplets;
}

}  // namespace semigeo::tests
