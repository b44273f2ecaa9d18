#include "kernels/recognition/feature_pair.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "kernels/recognition/near_features.hpp"

namespace semigeo::kernels {
namespace {

using Eigen::Vector3f;

/// The least length of the sum of both normals, projected across the pair. If it is shorter, noise
/// decides how the frame is turned.
constexpr float kLeastAcross = 0.5F;

class LevelPairs {
 public:
  LevelPairs(const PairOptions& options, std::vector<FeaturePair>& result)
      : options_(options), result_(result) {}

  /// Adds the pairs of one level. `first` is the index of its first feature.
  void add(std::span<const OrientedFeature> of_level, float sigma, std::size_t first) {
    of_level_ = of_level;
    sigma_ = sigma;
    first_ = first;
    near_.find(of_level, options_.nearest * sigma, options_.farthest * sigma, options_.neighbours);
    for (std::size_t i = 0; i < of_level.size(); ++i)
      for (const std::uint16_t j : near_.of(i))
        if (i < j || std::ranges::find(near_.of(j), i) == near_.of(j).end()) enter_in_order(i, j);
  }

 private:
  void enter_in_order(std::size_t i, std::size_t j) {
    const std::uint8_t one = of_level_[i].code;
    const std::uint8_t other = of_level_[j].code;
    const bool swapped = other < one || (other == one && j < i);
    enter(swapped ? j : i, swapped ? i : j);
    if (options_.every_order && one == other) enter(swapped ? i : j, swapped ? j : i);
  }

  void enter(std::size_t i, std::size_t j) {
    const OrientedFeature& p = of_level_[i];
    const OrientedFeature& q = of_level_[j];
    const Vector3f offset = q.position - p.position;
    FeaturePair pair;
    pair.length = offset.norm();
    const Vector3f along = offset / pair.length;
    Vector3f across = p.normal + q.normal;
    across -= along * across.dot(along);
    if (across.norm() < kLeastAcross) return;
    across.normalize();
    pair.frame << along, across, along.cross(across);
    pair.middle = 0.5F * (p.position + q.position);
    pair.log_length = std::log(pair.length / sigma_);
    pair.normals = {pair.frame.transpose() * p.normal, pair.frame.transpose() * q.normal};
    pair.curvatures = {p.scale_free_gaussian, p.scale_free_mean, q.scale_free_gaussian,
                       q.scale_free_mean};
    pair.codes = static_cast<std::uint16_t>(p.code * kFeatureCodes + q.code);
    pair.corners = {static_cast<std::uint16_t>(first_ + i), static_cast<std::uint16_t>(first_ + j)};
    result_.push_back(pair);
  }

  const PairOptions& options_;
  std::vector<FeaturePair>& result_;
  std::span<const OrientedFeature> of_level_;
  float sigma_ = 1;
  std::size_t first_ = 0;
  NearFeatures near_;
};

bool same_curvature(float a, float b) {
  return std::abs(a - b) <=
         kCurvatureTolerance + kCurvatureSlope * std::max(std::abs(a), std::abs(b));
}

}  // namespace

std::vector<FeaturePair> local_pairs(const OrientedFeatures& features, const PairOptions& options) {
  std::vector<FeaturePair> result;
  LevelPairs pairs(options, result);
  for_each_level(features, [&](auto of_level, float sigma, std::size_t first) {
    pairs.add(of_level, sigma, first);
  });
  std::ranges::sort(result, [](const FeaturePair& a, const FeaturePair& b) {
    return std::tie(a.codes, a.corners) < std::tie(b.codes, b.corners);
  });
  return result;
}

bool compatible(const FeaturePair& a, const FeaturePair& b) {
  if (std::abs(a.log_length - b.log_length) > kScaleTolerance) return false;
  for (std::size_t i = 0; i < a.curvatures.size(); ++i)
    if (!same_curvature(a.curvatures[i], b.curvatures[i])) return false;
  for (std::size_t i = 0; i < a.normals.size(); ++i)
    if (a.normals[i].dot(b.normals[i]) < kCosNormalTolerance) return false;
  return true;
}

std::vector<PairMatch> match_pairs(std::span<const FeaturePair> scene,
                                   std::span<const FeaturePair> model) {
  std::vector<PairMatch> matches;
  auto same = model.subspan(0, 0);
  for (std::size_t i = 0; i < scene.size(); ++i) {
    if (i == 0 || scene[i].codes != scene[i - 1].codes) {
      same = std::span(std::ranges::lower_bound(model, scene[i].codes, {}, &FeaturePair::codes),
                       std::ranges::upper_bound(model, scene[i].codes, {}, &FeaturePair::codes));
    }
    for (const FeaturePair& pair : same)
      if (compatible(scene[i], pair))
        matches.push_back(
            {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(&pair - model.data())});
  }
  return matches;
}

Similarity similarity_between(const FeaturePair& from, const FeaturePair& to) {
  Similarity result;
  result.scale = to.length / from.length;
  result.rotation = to.frame.cast<double>() * from.frame.cast<double>().transpose();
  result.translation =
      to.middle.cast<double>() - result.scale * (result.rotation * from.middle.cast<double>());
  return result;
}

}  // namespace semigeo::kernels
