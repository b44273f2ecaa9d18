#include "jobs/stages/stored_precision.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace semigeo::jobs {
namespace {

using Eigen::Vector3f;

/// A level of random numbers of many sizes.
struct RandomLevel {
  explicit RandomLevel(double step) {
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    const auto any = [&] { return std::exp(6 * normal(random)) * (normal(random) < 0 ? -1 : 1); };
    const auto vector = [&] { return Vector3f(normal(random), normal(random), normal(random)); };
    fields.step = step;
    for (int i = 0; i < 5000; ++i) {
      fields.points.push_back(100 * vector());
      fields.normals.push_back(vector().normalized());
      fields.gaussian_curvature.push_back(any());
      fields.mean_curvature.push_back(any());
      fields.patch_completeness.push_back(std::abs(normal(random)));
    }
    kernels::Feature feature;
    feature.value = any();
    feature.position = vector();
    feature.initial_position = vector();
    feature.normal = vector().normalized();
    features.of_kind[1] = {feature};
    features.contours[0].points = {vector(), vector()};
    features.contours[0].torsion = {any(), 0};
  }

  LevelFields fields;
  kernels::LevelFeatures features;
};

class StoredPrecisionTest : public ::testing::Test {
 protected:
  void round(RandomLevel& level, double first_step, bool first) {
    round_to_scan(level.fields, level.features, first_step, first, workers_);
  }
  engine::Workers workers_{2};
};

float error_of(const Vector3f& a, const Vector3f& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

TEST_F(StoredPrecisionTest, ErrorsAreBounded) {
  constexpr double kStep = 0.37;
  const RandomLevel exact(kStep);
  RandomLevel level(kStep);
  round(level, 0.5, false);
  for (std::size_t v = 0; v < exact.fields.points.size(); ++v) {
    EXPECT_LE(error_of(level.fields.points[v], exact.fields.points[v]), 1e-3 * kStep);
    EXPECT_LE(error_of(level.fields.normals[v], exact.fields.normals[v]), kNormalError);
    for (const auto field : {&LevelFields::gaussian_curvature, &LevelFields::mean_curvature,
                             &LevelFields::patch_completeness}) {
      const float is = (level.fields.*field)[v];
      const float was = (exact.fields.*field)[v];
      EXPECT_LE(std::abs(is - was), 0x1p-14f * std::abs(was));
    }
  }
  const kernels::Feature& feature = level.features.of_kind[1][0];
  const kernels::Feature& was = exact.features.of_kind[1][0];
  EXPECT_LE(error_of(feature.position, was.position), 1e-3 * kStep);
  EXPECT_LE(error_of(feature.initial_position, was.initial_position), 1e-3 * 0.5);
  EXPECT_LE(std::abs(feature.value - was.value), 0x1p-14f * std::abs(was.value));
  EXPECT_LE(error_of(level.features.contours[0].points[1], exact.features.contours[0].points[1]),
            1e-3 * kStep);
  EXPECT_EQ(level.features.contours[0].torsion[1], 0);
}

TEST_F(StoredPrecisionTest, NumbersAreMultiplesAndStaySoWhenRoundedAgain) {
  RandomLevel level(0.37);
  round(level, 0.37, false);
  const float quantum = position_quantum(0.37);
  EXPECT_EQ(quantum, 0x1p-11f);
  for (const Vector3f& point : level.fields.points)
    for (const float x : point) EXPECT_EQ(std::fmod(x, quantum), 0);
  const LevelFields once = level.fields;
  round(level, 0.37, false);
  EXPECT_EQ(level.fields.points, once.points);
  EXPECT_EQ(level.fields.normals, once.normals);
  EXPECT_EQ(level.fields.mean_curvature, once.mean_curvature);
}

TEST_F(StoredPrecisionTest, VerticesOfLevelZeroStay) {
  const RandomLevel exact(0.37);
  RandomLevel level(0.37);
  round(level, 0.37, true);
  EXPECT_EQ(level.fields.points, exact.fields.points);
  EXPECT_NE(level.fields.normals, exact.fields.normals);
}

TEST_F(StoredPrecisionTest, OddNumbersStayAsTheyAre) {
  RandomLevel level(0.37);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kLargest = std::numeric_limits<float>::max();
  level.fields.gaussian_curvature = {0, kInfinity, -kInfinity, kLargest,
                                     std::numeric_limits<float>::quiet_NaN()};
  level.fields.points = {{1e30f, kInfinity, 0}};
  round(level, 0.37, false);
  EXPECT_EQ(level.fields.gaussian_curvature[0], 0);
  EXPECT_EQ(level.fields.gaussian_curvature[1], kInfinity);
  EXPECT_EQ(level.fields.gaussian_curvature[2], -kInfinity);
  EXPECT_EQ(level.fields.gaussian_curvature[3], kLargest);
  EXPECT_TRUE(std::isnan(level.fields.gaussian_curvature[4]));
  EXPECT_EQ(level.fields.points[0], Vector3f(1e30f, kInfinity, 0));
}

TEST_F(StoredPrecisionTest, WithoutAStepPositionsStay) {
  for (const double step : {0.0, -1.0, 1e-200, 1e200, double(NAN), double(INFINITY)}) {
    EXPECT_EQ(position_quantum(step), 0) << step;
    const RandomLevel exact(step);
    RandomLevel level(step);
    round(level, step, false);
    EXPECT_EQ(level.fields.points, exact.fields.points);
  }
}

TEST_F(StoredPrecisionTest, TiesHaveNoDirection) {
  RandomLevel level(0.37);
  const float unit = 0x1p-13f;  // the last kept bit of numbers from 1 to 2
  level.fields.mean_curvature = {1 + 0.5f * unit, 1 + 1.5f * unit, -1 - 0.5f * unit,
                                 2 - 0.5f * unit};
  round(level, 0.37, false);
  EXPECT_EQ(level.fields.mean_curvature, (std::vector<float>{1, 1 + 2 * unit, -1, 2}));
}

}  // namespace
}  // namespace semigeo::jobs
