#include "kernels/recognition/surflet_histogram.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace semigeo::kernels {
namespace {

constexpr std::uint32_t kPartners = 16;
/// The distance that fills the last bin, in mean distances. Few pairs are farther apart.
constexpr float kFarthest = 2;

/// Returns one of `count` numbers that looks as if it were drawn by lot.
std::uint32_t lot(std::uint32_t sample, std::uint32_t turn, std::uint32_t count) {
  std::uint32_t mixed = sample * 2654435769U + turn * 2246822519U;
  mixed = (mixed ^ mixed >> 15) * 2246822519U;
  mixed = (mixed ^ mixed >> 13) * 3266489917U;
  mixed ^= mixed >> 16;
  return static_cast<std::uint32_t>(std::uint64_t{mixed} * count >> 32);
}

/// Returns the bin of a value between `least` and `most`.
std::size_t bin_of(float value, float least, float most) {
  const float share = (value - least) / (most - least);
  return static_cast<std::size_t>(std::clamp(share, 0.0F, 0.999F) *
                                  static_cast<float>(kSurfletBins));
}

/// Two points with their normals.
struct Pair {
  Eigen::Vector3f first, first_normal, second, second_normal;

  float distance() const { return (second - first).norm(); }

  /// Returns the bin of the pair. The order of its points does not matter.
  std::size_t bin(float mean_distance) const {
    const Eigen::Vector3f line = (second - first).normalized();
    // The origin is the point whose normal makes the smaller angle with the line: (1).
    const bool turned = std::abs(first_normal.dot(line)) > std::abs(second_normal.dot(line));
    const Eigen::Vector3f u = turned ? second_normal : first_normal;
    const Eigen::Vector3f other = turned ? first_normal : second_normal;
    const Eigen::Vector3f towards = turned ? Eigen::Vector3f(-line) : line;
    const Eigen::Vector3f v = towards.cross(u).normalized();
    const Eigen::Vector3f w = u.cross(v);
    constexpr auto pi = std::numbers::pi_v<float>;
    const float alpha = std::atan2(w.dot(other), u.dot(other));  // (2)
    const float beta = v.dot(other);                             // (3)
    const float gamma = u.dot(towards);                          // (4)
    const float delta = distance() / mean_distance;              // (5)
    return ((bin_of(alpha, -pi, pi) * kSurfletBins + bin_of(beta, -1, 1)) * kSurfletBins +
            bin_of(gamma, -1, 1)) *
               kSurfletBins +
           bin_of(delta, 0, kFarthest);
  }
};

}  // namespace

SurfletHistogram surflet_histogram(const SurfaceSamples& samples) {
  const auto count = static_cast<std::uint32_t>(samples.points.size());
  SurfletHistogram histogram = {};
  const auto for_each_pair = [&](const auto& body) {
    for (std::uint32_t i = 0; i < count; ++i)
      for (std::uint32_t turn = 0; turn < kPartners; ++turn) {
        const std::uint32_t j = lot(i, turn, count);
        const Pair pair = {samples.points[i], samples.normals[i], samples.points[j],
                           samples.normals[j]};
        if (pair.distance() > 0) body(pair);
      }
  };
  double sum = 0;
  std::int64_t pairs = 0;
  for_each_pair([&](const Pair& pair) {
    sum += static_cast<double>(pair.distance());
    ++pairs;
  });
  if (pairs == 0) return histogram;
  const auto mean = static_cast<float>(sum / static_cast<double>(pairs));
  std::vector<std::int32_t> counts(histogram.size());
  for_each_pair([&](const Pair& pair) { ++counts[pair.bin(mean)]; });
  for (std::size_t bin = 0; bin < counts.size(); ++bin)
    histogram[bin] = static_cast<float>(counts[bin]) / static_cast<float>(pairs);
  return histogram;
}

double resemblance(const SurfletHistogram& a, const SurfletHistogram& b) {
  double sum = 0;
  for (std::size_t bin = 0; bin < a.size(); ++bin)
    sum += static_cast<double>(std::min(a[bin], b[bin]));
  return sum;
}

}  // namespace semigeo::kernels
