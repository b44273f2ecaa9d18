#include "kernels/features/torsion.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kernels/patch/gaussian.hpp"

namespace semigeo::kernels {
namespace {

/// The curvature times sample distance below which a curve counts as straight. A straight curve has
/// no osculating plane.
constexpr double kStraight = 1e-3;
/// The height of the pass where nothing higher can be reached.
constexpr float kNoPass = -1;

}  // namespace

double length_of(std::span<const Eigen::Vector3d> points, bool closed) {
  double length = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) length += (points[i + 1] - points[i]).norm();
  if (closed && !points.empty()) length += (points.front() - points.back()).norm();
  return length;
}

ArcSamples resample(std::span<const Eigen::Vector3d> points, bool closed, double spacing) {
  ArcSamples samples;
  if (points.empty()) return samples;
  const double length = length_of(points, closed);
  if (!(length > 0) || !(spacing > 0)) {
    samples.at.push_back({0, 0});
    return samples;
  }
  const auto pieces = std::max<std::int64_t>(closed ? 3 : 1, std::llround(length / spacing));
  samples.spacing = length / static_cast<double>(pieces);
  const std::int64_t count = closed ? pieces : pieces + 1;
  const std::size_t segments = closed ? points.size() : points.size() - 1;
  std::size_t segment = 0;
  double begin = 0;
  const auto segment_length = [&](std::size_t s) {
    return (points[(s + 1) % points.size()] - points[s]).norm();
  };
  double here = segment_length(0);
  for (std::int64_t k = 0; k < count; ++k) {
    const double wanted = static_cast<double>(k) * samples.spacing;
    while (segment + 1 < segments && begin + here < wanted) {
      begin += here;
      here = segment_length(++segment);
    }
    const double fraction = here > 0 ? std::clamp((wanted - begin) / here, 0.0, 1.0) : 0.0;
    samples.at.push_back({static_cast<std::int32_t>(segment), static_cast<float>(fraction)});
  }
  return samples;
}

std::vector<float> torsion(std::span<const Eigen::Vector3d> samples, bool closed) {
  const auto n = static_cast<std::int64_t>(samples.size());
  std::vector<float> result(samples.size(), 0.0f);
  if (n < kTaps) return result;
  const GaussianFilters& filters = gaussian_filters();
  for (std::int64_t i = 0; i < n; ++i) {
    if (!closed && (i < kReach || i + kReach >= n)) continue;
    Eigen::Vector3d r1 = Eigen::Vector3d::Zero(), r2 = r1, r3 = r1;
    for (int k = 0; k < kTaps; ++k) {
      // Points are taken relative to the sample, so that no digits are lost far from the origin.
      const Eigen::Vector3d r = samples[(i + k - kReach + n) % n] - samples[i];
      r1 += filters.first[k] * r;   // (4.15)
      r2 += filters.second[k] * r;  // (4.15)
      r3 += filters.third[k] * r;   // (4.15)
    }
    const Eigen::Vector3d binormal = r1.cross(r2);
    if (!(binormal.norm() > kStraight * std::pow(r1.norm(), 2))) continue;
    result[i] = static_cast<float>(binormal.dot(r3) / binormal.squaredNorm());  // (4.14)
  }
  return result;
}

std::vector<std::int32_t> torsion_maxima(std::span<const float> torsion, bool closed) {
  const auto n = static_cast<std::int64_t>(torsion.size());
  std::vector<std::int32_t> maxima;
  for (std::int64_t i = closed ? 0 : 1; i < (closed ? n : n - 1); ++i) {
    const float here = std::abs(torsion[i]);
    if (here > std::abs(torsion[(i + n - 1) % n]) && here > std::abs(torsion[(i + 1) % n]))
      maxima.push_back(static_cast<std::int32_t>(i));
  }
  return maxima;
}

std::vector<float> torsion_prominences(std::span<const float> torsion, bool closed) {
  const auto n = static_cast<std::int64_t>(torsion.size());
  const std::int64_t laps = closed ? 2 : 1;
  std::vector<float> passes(torsion.size(), kNoPass);
  struct Step {
    float height;
    float lowest;  // the lowest height between the step before and this one
  };
  std::vector<Step> descending;
  for (const bool forwards : {true, false}) {
    descending.clear();
    for (std::int64_t k = 0; k < laps * n; ++k) {
      const std::int64_t i = forwards ? k % n : n - 1 - k % n;
      const float height = std::abs(torsion[i]);
      float lowest = height;
      while (!descending.empty() && descending.back().height <= height) {
        lowest = std::min({lowest, descending.back().height, descending.back().lowest});
        descending.pop_back();
      }
      // Closed contours take two laps. In the second lap `descending` holds the whole contour.
      if (!descending.empty()) passes[i] = std::max(passes[i], lowest);
      descending.push_back({height, lowest});
    }
  }
  std::vector<float> result(torsion.size());
  for (std::int64_t i = 0; i < n; ++i)
    result[i] = std::abs(torsion[i]) - (passes[i] == kNoPass ? 0 : passes[i]);
  return result;
}

}  // namespace semigeo::kernels
