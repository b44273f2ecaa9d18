#include "kernels/recognition/surflet_histogram.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace semigeo::kernels {
namespace {

using Eigen::Vector3f;

/// Samples of an ellipsoid with these half-axes, spread by a spiral that begins at `phase`.
SurfaceSamples ellipsoid(const Vector3f& axes, double phase, int count = 4000) {
  SurfaceSamples samples;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count;
    const double angle = 2.399963229728653 * i + phase;
    const double r = std::sqrt(1 - z * z);
    const Vector3f unit(static_cast<float>(r * std::cos(angle)),
                        static_cast<float>(r * std::sin(angle)), static_cast<float>(z));
    samples.points.push_back(unit.cwiseProduct(axes));
    samples.normals.push_back(unit.cwiseQuotient(axes).normalized());
  }
  return samples;
}

SurfaceSamples moved(SurfaceSamples samples, float scale, const Eigen::Quaternionf& rotation,
                     const Vector3f& translation) {
  for (Vector3f& p : samples.points) p = scale * (rotation * p) + translation;
  for (Vector3f& n : samples.normals) n = rotation * n;
  return samples;
}

TEST(SurfletHistogram, HoldsSharesOfAllPairs) {
  const SurfletHistogram histogram = surflet_histogram(ellipsoid({1, 2, 3}, 0));
  EXPECT_NEAR(std::accumulate(histogram.begin(), histogram.end(), 0.0), 1.0, 1e-5);
}

// On a sphere of radius 1 the distance d of two points drawn by lot has the density d / 2 in [0, 2]
// (Archimedes), with the mean 4/3. A bin of distances is 0.4 means wide, and the last one has all
// that is farther than 1.6 means, which no pair is.
TEST(SurfletHistogram, OfASphereHasTheDistancesOfChords) {
  const SurfletHistogram histogram = surflet_histogram(ellipsoid({1, 1, 1}, 0));
  std::array<double, kSurfletBins> shares = {};
  for (std::size_t bin = 0; bin < histogram.size(); ++bin)
    shares[bin % kSurfletBins] += static_cast<double>(histogram[bin]);
  for (std::size_t i = 0; i < kSurfletBins; ++i) {
    const auto part_below = [](double d) { return std::min(d, 2.0) * std::min(d, 2.0) / 4; };
    const double width = 0.4 * 4 / 3;
    const auto at = static_cast<double>(i);
    EXPECT_NEAR(shares[i], part_below((at + 1) * width) - part_below(at * width), 0.01) << i;
  }
}

// Normals of a sphere point along its radii, so that v, which is at right angles to a radius and a
// chord, is at right angles to the other radius: beta is 0.
TEST(SurfletHistogram, OfASphereHasNoTwist) {
  const SurfletHistogram histogram = surflet_histogram(ellipsoid({1, 1, 1}, 0));
  for (std::size_t bin = 0; bin < histogram.size(); ++bin)
    if (bin / (kSurfletBins * kSurfletBins) % kSurfletBins != kSurfletBins / 2) {
      EXPECT_EQ(histogram[bin], 0) << bin;
    }
}

TEST(SurfletHistogram, IsThatOfAnySimilarSurface) {
  const SurfaceSamples samples = ellipsoid({1, 2, 3}, 0);
  const Eigen::Quaternionf rotation(Eigen::AngleAxisf(1, Vector3f(1, 2, 3).normalized()));
  const SurfaceSamples other = moved(samples, 0.01F, rotation, {5, -6, 7});
  EXPECT_GT(resemblance(surflet_histogram(samples), surflet_histogram(other)), 0.995);
}

TEST(SurfletHistogram, OfOtherSamplesIsNearlyTheSame) {
  const SurfletHistogram one = surflet_histogram(ellipsoid({1, 2, 3}, 0));
  EXPECT_GT(resemblance(one, surflet_histogram(ellipsoid({1, 2, 3}, 1))), 0.95);
  EXPECT_GT(resemblance(one, surflet_histogram(ellipsoid({1, 2, 3}, 0, 3000))), 0.94);
}

TEST(SurfletHistogram, IsLessAlikeTheMoreShapesDiffer) {
  const SurfletHistogram sphere = surflet_histogram(ellipsoid({1, 1, 1}, 0));
  double last = 1;
  for (const float longest : {1.1F, 1.5F, 2.5F, 6.0F}) {
    const double alike = resemblance(sphere, surflet_histogram(ellipsoid({1, 1, longest}, 0)));
    EXPECT_LT(alike, last) << longest;
    last = alike;
  }
  EXPECT_LT(last, 0.5);
}

// The way in which a surface faces is a part of its shape: a bowl is no dome.
TEST(SurfletHistogram, OfASurfaceTurnedOverIsAnother) {
  SurfaceSamples samples = ellipsoid({1, 2, 3}, 0);
  const SurfletHistogram outside = surflet_histogram(samples);
  for (Vector3f& n : samples.normals) n = -n;
  EXPECT_LT(resemblance(outside, surflet_histogram(samples)), 0.5);
}

TEST(SurfletHistogram, OfTooFewSamplesIsEmpty) {
  for (int count = 0; count < 2; ++count) {
    const SurfletHistogram histogram = surflet_histogram(ellipsoid({1, 1, 1}, 0, count));
    EXPECT_EQ(std::accumulate(histogram.begin(), histogram.end(), 0.0F), 0.0F);
    EXPECT_EQ(resemblance(histogram, histogram), 0);
  }
}

}  // namespace
}  // namespace semigeo::kernels
